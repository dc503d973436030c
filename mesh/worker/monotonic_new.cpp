// operator new for the whole mesher process, its libraries included: small blocks come from ever
// higher addresses, and no address is used twice.
//
// Why: Gmsh numbers the nodes that it hands to HXT in the order of their addresses. With the C
// library's allocator that order, and with it the mesh, changes with all that the process did
// before and even with its environment variables (measured: 25 of 25 grains differ when their batch
// is reversed). Here the order of addresses is the order of creation, and a grain's mesh depends on
// the grain alone.

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t region_size = std::size_t{1} << 36;  // addresses, not memory
constexpr std::size_t chunk_size = std::size_t{1} << 20;
constexpr std::size_t largest_block = 1024;  // larger ones: malloc
constexpr std::size_t alignment = alignof(std::max_align_t);

/// Blocks in order of address. A chunk becomes memory when it is reached and gives it back when all
/// its blocks have been deleted.
class Region {
 public:
  /// nullptr if the addresses have run out.
  void* take(std::size_t size) {
    size = std::max(size + alignment - 1, alignment) / alignment * alignment;
    const Lock lock(busy_);
    if (begin_ == nullptr && !reserve()) return nullptr;
    if (next_ + size > end_ && !open_chunk()) return nullptr;
    void* block = begin_ + next_;
    ++live_[next_ / chunk_size];
    next_ += size;
    return block;
  }

  /// False for a block that is not from here.
  bool give_back(void* block) {
    const Lock lock(busy_);
    const char* place = static_cast<char*>(block);
    if (begin_ == nullptr || place < begin_ || place >= begin_ + region_size) return false;
    const std::size_t chunk = static_cast<std::size_t>(place - begin_) / chunk_size;
    if (--live_[chunk] == 0 && (chunk + 1) * chunk_size != end_) close_chunk(chunk);
    return true;
  }

 private:
  class Lock {
   public:
    explicit Lock(std::atomic_flag& flag) : flag_(flag) {
      while (flag_.test_and_set(std::memory_order_acquire)) {
      }
    }
    ~Lock() { flag_.clear(std::memory_order_release); }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    std::atomic_flag& flag_;
  };

  bool reserve() {
    void* place =
        mmap(nullptr, region_size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) return false;
    begin_ = static_cast<char*>(place);
    return true;
  }
  /// The next chunk becomes the one that blocks are taken from.
  bool open_chunk() {
    if (end_ == region_size || mprotect(begin_ + end_, chunk_size, PROT_READ | PROT_WRITE) != 0)
      return false;
    if (end_ > 0 && live_[end_ / chunk_size - 1] == 0) close_chunk(end_ / chunk_size - 1);
    next_ = end_;
    end_ += chunk_size;
    return true;
  }
  void close_chunk(std::size_t chunk) {
    mmap(begin_ + chunk * chunk_size, chunk_size, PROT_NONE,
         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0);
  }

  std::atomic_flag busy_;
  char* begin_ = nullptr;
  std::size_t next_ = 0;                                        // offset of the next block
  std::size_t end_ = 0;                                         // of the end of its chunk
  std::array<std::uint32_t, region_size / chunk_size> live_{};  // blocks in each chunk
};

constinit Region region;

}  // namespace

void* operator new(std::size_t size) {
  void* block = size <= largest_block ? region.take(size) : nullptr;
  if (block == nullptr) block = std::malloc(std::max<std::size_t>(size, 1));
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

void operator delete(void* block) noexcept {
  if (block != nullptr && !region.give_back(block)) std::free(block);
}

void operator delete(void* block, std::size_t) noexcept { operator delete(block); }

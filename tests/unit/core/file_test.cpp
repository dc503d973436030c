#include "core/file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "core/handle.hpp"

namespace polyslip::core {
namespace {

namespace fs = std::filesystem;

class File : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("polyslip_file_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

std::string error_of(auto&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(File, WritesAndReadsBackAndLeavesNoPart) {
  const std::string content("a\0b\n", 4);
  write_file(path("a"), "first");
  write_file(path("a"), content);
  EXPECT_EQ(read_text(path("a")), content);
  EXPECT_FALSE(fs::exists(part_path(path("a"))));
}

TEST_F(File, RoomIsFoundOrNot) {
  EXPECT_NO_THROW(require_room(path("state"), 100'000));
  EXPECT_EQ(fs::file_size(part_path(path("state"))), 0u);
  EXPECT_THROW(require_room(path("state"), std::uint64_t(1) << 60), InputError);
  EXPECT_FALSE(fs::exists(part_path(path("state"))));
  EXPECT_THROW(require_room(path("no/state"), 1), InputError);
}

TEST_F(File, MissingFileAndFolderAreNamed) {
  EXPECT_EQ(error_of([&] { read_text(path("none")); }), path("none") + ": no such file");
  EXPECT_EQ(error_of([&] { write_file(path("no/where"), "x"); }),
            path("no/where") + ": cannot write: No such file or directory");
}

TEST_F(File, AFolderIsNotAFile) {
  EXPECT_EQ(error_of([&] { read_text(folder_.string()); }),
            folder_.string() + ": cannot read: Is a directory");
  fs::create_directories(path("taken"));
  EXPECT_EQ(error_of([&] { write_file(path("taken"), "x"); }),
            path("taken") + ": cannot rename: Is a directory");
  EXPECT_FALSE(fs::exists(part_path(path("taken"))));
}

// A limit on file sizes stands in for a full disk: write() fails after some bytes.
TEST_F(File, AFailedWriteKeepsTheOldFile) {
  write_file(path("a"), "old");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  auto* handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] { write_file(path("a"), std::string(10000, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, path("a") + ": cannot write: File too large");
  EXPECT_EQ(read_text(path("a")), "old");
  EXPECT_FALSE(fs::exists(part_path(path("a"))));
}

TEST_F(File, APieceByPieceFileIsTheSameText) {
  std::string expected;
  {
    FileWriter writer(path("a"));
    for (int i = 0; i < 300'000; ++i) {
      writer.put(i);
      writer.put(' ');
      expected += std::to_string(i) + " ";
    }
    writer.put(0.1);
    writer.put("\n");
    EXPECT_FALSE(fs::exists(path("a")));
    writer.finish();
  }
  EXPECT_EQ(read_text(path("a")), expected + "0.1\n");
  EXPECT_FALSE(fs::exists(part_path(path("a"))));
  { FileWriter(path("a")).put("never finished"); }
  EXPECT_EQ(read_text(path("a")), expected + "0.1\n");
  EXPECT_FALSE(fs::exists(part_path(path("a"))));
}

TEST_F(File, AFullDiskLeavesNothingOfAPieceByPieceFile) {
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  auto* handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1 << 20, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] {
    FileWriter writer(path("a"));
    for (int i = 0; i < 1'000'000; ++i) writer.put(i);
    writer.finish();
  });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, path("a") + ": cannot write: File too large");
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(File, PublishNeedsThePart) {
  EXPECT_EQ(error_of([&] { publish_part(path("h5")); }),
            part_path(path("h5")) + ": cannot open: No such file or directory");
  std::ofstream(part_path(path("h5"))) << "done";
  publish_part(path("h5"));
  EXPECT_EQ(read_text(path("h5")), "done");
}

TEST_F(File, FoldersAreMadeAndTried) {
  make_folder(path("x/y"));
  EXPECT_NO_THROW(require_writable_folder(path("x/y")));
  EXPECT_TRUE(fs::is_empty(path("x/y")));
  EXPECT_EQ(error_of([&] { require_writable_folder(path("z")); }),
            path("z") + ": cannot write in this folder: No such file or directory");
  write_file(path("file"), "");
  EXPECT_EQ(error_of([&] { make_folder(path("file")); }),
            path("file") + ": cannot make this folder: Not a directory");
}

int closed = 0;
int close_number(int) { return ++closed; }
void close_pointer(int** p) { ++**p, *p = nullptr; }

TEST(Handle, ClosesOnceAndMovesByExchange) {
  using Number = Handle<int, close_number, -1>;
  closed = 0;
  {
    Number a(5), b;
    b = std::move(a);
    EXPECT_FALSE(a);
    EXPECT_EQ(b.get(), 5);
    Number c(std::move(b));
    EXPECT_EQ(closed, 0);
    EXPECT_EQ(c.close(), 1);
    EXPECT_EQ(c.close(), 0);
    Number d(7);
    EXPECT_EQ(d.release(), 7);
  }
  EXPECT_EQ(closed, 1);
}

TEST(Handle, TakesFunctionsOfAPointer) {
  int count = 0;
  {
    Handle<int*, close_pointer> a;
    *a.receive() = &count;
    EXPECT_EQ(a.get(), &count);
  }
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace polyslip::core

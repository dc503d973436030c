#pragma once
// Where the time of a run goes: CPU and wall seconds by stage, and the messages between ranks. For
// reports only: nothing is decided by a clock.

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace polyslip::solver {

/// Stages may be nested: each is booked without what runs inside it. Of one rank; on one thread.
class Profile {
 public:
  struct Entry {
    std::string stage;
    double cpu = 0, wall = 0;  ///< s, of this process (all its threads); s
    std::int64_t calls = 0;
  };
  /// In the order in which the stages first ended.
  const std::vector<Entry>& entries() const { return entries_; }
  std::int64_t messages() const { return messages_; }      ///< sent by this rank
  std::int64_t bytes() const { return bytes_; }            ///< sent by this rank
  std::int64_t reductions() const { return reductions_; }  ///< over all ranks

  void count_message(std::size_t bytes) {
    ++messages_;
    bytes_ += static_cast<std::int64_t>(bytes);
  }
  void count_reduction() { ++reductions_; }
  /// From now on every stage is a stage of PETSc's log too (of the same name). PETSc must run.
  void log_with_petsc();
  /// Forgets what has been booked; call outside of any stage.
  void clear();

 private:
  friend class Stage;
  struct Open {
    const char* stage;
    double cpu, wall;  // so far, without what runs inside
  };
  void enter(const char* stage);
  void leave();
  void charge();

  std::vector<Entry> entries_;
  std::vector<Open> open_;
  double cpu_ = 0, wall_ = 0;  // at the last change of stage
  std::int64_t messages_ = 0, bytes_ = 0, reductions_ = 0;
  bool petsc_ = false;
};

/// Books the time until it goes out of scope; without a profile it does nothing. `stage`: a
/// literal.
class Stage {
 public:
  Stage(Profile* profile, const char* stage) : profile_(profile) {
    if (profile_) profile_->enter(stage);
  }
  ~Stage() {
    if (profile_) profile_->leave();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  Profile* profile_;
};

/// A table of the stages over all ranks, and what was sent; on rank 0, empty elsewhere. Collective.
std::string profile_text(const Profile& profile, MPI_Comm comm);
/// PETSc's own log since `log_with_petsc` into a file: its events in each stage. Collective.
void write_petsc_log(const std::string& path);

}  // namespace polyslip::solver

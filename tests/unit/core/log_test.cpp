#include "core/log.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/timer.hpp"
#include "core/version.hpp"

namespace polyslip::core {
namespace {

TEST(Log, LinesGoToTheConsoleAndTheFileEarlyOnesToo) {
  const auto path = (std::filesystem::temp_directory_path() /
                     ("polyslip_log_" + std::to_string(::getpid()) + ".txt"))
                        .string();
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  {
    Log log;
    log.info("before {}", 1);
    log.to_file(path);
    log.warning("after {{}}");
    log.info("a brace { alone");
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "before 1\na brace { alone\n");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "warning: after {{}}\n");
  const std::string text = read_text(path);
  EXPECT_NE(text.find(" before 1\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" warning: after {{}}\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" a brace { alone\n"), std::string::npos) << text;
  std::filesystem::remove(path);
}

TEST(Log, SilentSaysNothing) {
  ::testing::internal::CaptureStdout();
  Log log = Log::silent();
  log.info("nothing");
  log.progress("nothing", 1, 2);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST(Log, AFileThatCannotBeOpenedIsAnInputError) {
  Log log;
  EXPECT_THROW(log.to_file("/proc/no/such/log.txt"), InputError);
}

TEST(Log, ProgressSaysWhatHowFarHowLongStill) {
  EXPECT_EQ(progress_text("deforming", 0, 2, 0), "deforming: 0 %");
  EXPECT_EQ(progress_text("deforming", 0.5, 2, 10), "deforming: 25 %, 30 s left");
  EXPECT_EQ(progress_text("deforming", 2, 2, 10), "deforming: 100 %");
  EXPECT_EQ(progress_text("mesh", 1, 4, 20, "checking"), "mesh: 25 % (checking), 1 min left");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(90), "2 min");
  EXPECT_EQ(duration_text(3600 * 3 + 20 * 60), "3 h 20 min");
}

// What a log writes of a first call for progress to a terminal so many columns wide.
std::string on_terminal(unsigned short columns) {
  int outer = -1, inner = -1;
  winsize size{};
  size.ws_row = 24;
  size.ws_col = columns;
  if (::openpty(&outer, &inner, nullptr, nullptr, &size) != 0) return "no terminal to be had";
  std::fflush(stdout);
  const int before = ::dup(STDOUT_FILENO);
  ::dup2(inner, STDOUT_FILENO);
  {
    Log log;
    log.progress("meshing", "", 0, 4);
    log.info("done");
  }
  std::fflush(stdout);
  ::dup2(before, STDOUT_FILENO);
  ::close(before);
  ::close(inner);
  // In pieces, as the kernel hands it over; an error says that the other end is closed and no more
  // comes.
  std::string text;
  char piece[256];
  for (ssize_t n = 0; (n = ::read(outer, piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<size_t>(n));
  ::close(outer);
  return text;
}

TEST(Log, ProgressIsDrawnOnATerminalThatHasAWidth) {
  EXPECT_EQ(on_terminal(80), "\r\033[Kmeshing: 0 %\r\033[Kdone\r\n");
  EXPECT_EQ(on_terminal(0), "done\r\n");  // as mpirun gives it
}

TEST(Timer, StagesAddUpInOrder) {
  StageTimes times;
  times.add("b", 1);
  times.add("a", 2);
  times.add("b", 3);
  ASSERT_EQ(times.stages().size(), 2u);
  EXPECT_EQ(times.stages()[0].first, "b");
  EXPECT_EQ(times.seconds("b"), 4);
  EXPECT_EQ(times.seconds("none"), 0);
}

TEST(Timer, MeasuresCpuSeconds) {
  StageTimes times;
  {
    const auto m = times.measure("spin");
    const double start = process_cpu_seconds();
    volatile double x = 0;
    while (process_cpu_seconds() - start < 0.02) x = x + 1;
  }
  EXPECT_GE(times.seconds("spin"), 0.02);
  EXPECT_LT(times.seconds("spin"), 5);
  EXPECT_GT(peak_rss_mb(), 1);
  EXPECT_LT(peak_rss_mb(), 1e5);
}

TEST(Version, StartsWithTheProjects) { EXPECT_EQ(version().rfind("0.1.0", 0), 0u) << version(); }

}  // namespace
}  // namespace polyslip::core

#include "core/log.hpp"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <vector>

#include "core/error.hpp"
#include "core/timer.hpp"

namespace polyslip::core {

namespace {

// Seconds between two plain lines of progress, and between two updates of a terminal's.
constexpr double plain_interval = 10;
constexpr double terminal_interval = 0.2;

// Whether somebody looks at it: mpirun gives its ranks a terminal of no width, whatever it writes
// to itself, and lines that overwrite each other would fill a log.
bool is_terminal(int descriptor) {
  winsize size{};
  return ::isatty(descriptor) == 1 && ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 &&
         size.ws_col > 0;
}

}  // namespace

struct Log::Impl {
  bool speaks = true;
  bool terminal = false;
  bool progress_shown = false;  // the terminal's last line is one of progress
  std::string progress_what;
  double progress_start = 0, progress_last = 0;
  std::vector<std::pair<spdlog::level::level_enum, std::string>> early;  // before there was a file
  std::unique_ptr<spdlog::logger> file;

  void clear_progress() {
    if (progress_shown) std::fputs("\r\033[K", stdout);
    progress_shown = false;
  }

  void line(spdlog::level::level_enum level, const std::string& text) {
    if (!speaks) return;
    clear_progress();
    std::FILE* stream = level == spdlog::level::info ? stdout : stderr;
    if (stream == stderr) std::fflush(stdout);
    std::fputs((text + "\n").c_str(), stream);
    std::fflush(stream);
    if (file)
      file->log(level, text);
    else
      early.emplace_back(level, text);
  }
};

Log::Log() : impl_(std::make_unique<Impl>()) { impl_->terminal = is_terminal(STDOUT_FILENO); }
Log::Log(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Log::Log(Log&&) noexcept = default;
Log& Log::operator=(Log&&) noexcept = default;
Log::~Log() {
  if (impl_ && impl_->speaks) impl_->clear_progress();
}

Log Log::silent() {
  auto impl = std::make_unique<Impl>();
  impl->speaks = false;
  return Log(std::move(impl));
}

void Log::to_file(const std::string& path) {
  if (!impl_->speaks) return;
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path);
    impl_->file = std::make_unique<spdlog::logger>("polyslip", std::move(sink));
  } catch (const spdlog::spdlog_ex& error) {
    throw InputError(path + ": cannot write the log: " + error.what());
  }
  impl_->file->set_pattern("%Y-%m-%d %H:%M:%S %v");
  impl_->file->flush_on(spdlog::level::info);
  for (const auto& [level, text] : impl_->early) impl_->file->log(level, text);
  impl_->early.clear();
}

void Log::info(const std::string& line) { impl_->line(spdlog::level::info, line); }
void Log::warning(const std::string& line) { impl_->line(spdlog::level::warn, "warning: " + line); }
void Log::error(const std::string& line) { impl_->line(spdlog::level::err, "error: " + line); }

void Log::progress(const std::string& what, const std::string& stage, double done, double total) {
  if (!impl_->speaks) return;
  const double now = wall_seconds();
  const bool first = what != impl_->progress_what;
  if (first) {
    impl_->progress_what = what;
    impl_->progress_start = impl_->progress_last = now;
  }
  const double interval = impl_->terminal ? terminal_interval : plain_interval;
  if (now - impl_->progress_last < interval && !(first && impl_->terminal)) return;
  impl_->progress_last = now;
  const std::string text = progress_text(what, done, total, now - impl_->progress_start, stage);
  if (impl_->terminal) {
    std::fputs(("\r\033[K" + text).c_str(), stdout);
    impl_->progress_shown = true;
  } else {
    std::fputs((text + "\n").c_str(), stdout);
  }
  std::fflush(stdout);
}

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(std::llround(std::max(0.0, seconds)));
  if (s < 60) return fmt::format("{} s", s);
  const long min = (s + 30) / 60;
  if (min < 60) return fmt::format("{} min", min);
  return fmt::format("{} h {} min", min / 60, min % 60);
}

std::string progress_text(const std::string& what, double done, double total, double elapsed,
                          const std::string& stage) {
  const double fraction = total > 0 ? std::clamp(done / total, 0.0, 1.0) : 0;
  std::string text = fmt::format("{}: {:.0f} %", what, 100 * fraction);
  if (!stage.empty()) text += " (" + stage + ")";
  if (fraction >= 1e-3 && fraction < 1)
    text += ", " + duration_text(elapsed * (1 - fraction) / fraction) + " left";
  return text;
}

}  // namespace polyslip::core

#pragma once
// What the user reads: lines on the console and in log.txt, and one line of progress.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

namespace polyslip::core {

/// A log to pass around. Rank 0 speaks; the others hold `Log::silent()`.
class Log {
 public:
  /// Lines go to the standard output, warnings to the standard error.
  Log();
  /// Says nothing, anywhere.
  static Log silent();
  Log(Log&&) noexcept;
  Log& operator=(Log&&) noexcept;
  ~Log();

  /// From here on lines also go to `path`, with date and time, after what is in it already; lines
  /// logged before are written first. InputError if the file cannot be opened.
  void to_file(const std::string& path);

  void info(const std::string& line);
  /// "warning: ..."
  void warning(const std::string& line);
  /// "error: ..."
  void error(const std::string& line);
  template <class... Args>
  void info(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0) {
    info(fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0) {
    warning(fmt::format(format, std::forward<Args>(args)...));
  }

  /// How far `what` is: `done` of `total`, any unit. On a terminal a line that rewrites itself,
  /// with how long still; elsewhere a line now and then (not in log.txt). A new `what` starts its
  /// clock.
  void progress(const std::string& what, double done, double total) {
    progress(what, {}, done, total);
  }
  /// With the stage of it that is at work; a new stage does not start the clock anew.
  void progress(const std::string& what, const std::string& stage, double done, double total);

 private:
  struct Impl;
  explicit Log(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// "55 s", "12 min", "3 h 20 min"
std::string duration_text(double seconds);

/// "deforming: 42 %, 3 min left"; without the last part until a tenth of a per cent is done. With a
/// stage "mesh: 42 % (checking), 3 min left".
std::string progress_text(const std::string& what, double done, double total, double elapsed,
                          const std::string& stage = {});

}  // namespace polyslip::core

// Time and memory of `polyslip mesh` on large polycrystals (docs/benchmarks.md):
// mesh_scale DECK --out DIR
#include <fmt/core.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "process_memory.hpp"

namespace {

using namespace polyslip::benchmarks;

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

[[noreturn]] void become(const std::string& program, const std::string& deck,
                         const std::string& folder) {
  execl(program.c_str(), program.c_str(), "mesh", deck.c_str(), "--out", folder.c_str(),
        "--overwrite", static_cast<char*>(nullptr));
  std::perror(program.c_str());
  _exit(127);
}

void print(const std::string& folder, const rusage& usage, const Memory& peak, double wall) {
  const auto summary = nlohmann::json::parse(std::ifstream(folder + "/summary.json"));
  const double cpu = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  const double grains = summary.at("grains"), elements = summary.at("elements_initial");
  fmt::print("grains {:.0f}, elements {:.0f}, nodes {}; radius ratio {:.3f} worst, {:.3f} mean\n",
             grains, elements, summary.at("nodes_initial").get<long>(),
             summary.at("min_radius_ratio").get<double>(),
             summary.at("mean_radius_ratio").get<double>());
  fmt::print("CPU {:.1f} s, {:.2f} ms a grain, all processes; wall {:.1f} s\n", cpu,
             1e3 * cpu / grains, wall);
  for (const auto& [stage, value] : summary.at("cpu_s").items())
    fmt::print("  {:<16}{:9.2f} s{:9.3f} ms a grain\n", stage, value.get<double>(),
               1e3 * value.get<double>() / grains);
  fmt::print("peak memory {:.0f} MB, of it the main process {:.0f} MB; {:.0f} bytes an element\n",
             peak.all, peak.main, 1e6 * peak.all / elements);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs polyslip mesh and measures it, all processes together.");
  std::string program = POLYSLIP_BINARY_DIR "/polyslip", deck, folder;
  double interval = 0.5;
  app.add_option("deck", deck)->required();
  app.add_option("--out", folder)->required();
  app.add_option("--program", program);
  app.add_option("--interval", interval, "seconds between two looks at the memory");
  CLI11_PARSE(app, argc, argv);

  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) become(program, deck, folder);
  Memory peak;
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, WNOHANG, &usage) == 0) {
    const Memory now = memory_of(child);
    peak.main = std::max(peak.main, now.main);
    peak.all = std::max(peak.all, now.all);
    std::this_thread::sleep_for(std::chrono::duration<double>(interval));
  }
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    fmt::print(stderr, "{} failed\n", program);
    return 1;
  }
  print(folder, usage, peak, wall);
  return 0;
}

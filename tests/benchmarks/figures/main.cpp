// paper_figures NAME...: see docs/figures.md and scripts/figure.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/timer.hpp"
#include "figures.hpp"

namespace {

using namespace polyslip;

std::map<std::string, figures::Maker> all_figures() {
  auto all = figures::tessellation_figures();
  all.merge(figures::mesh_figures());
  all.merge(figures::table_figures());
  return all;
}

/// Puts the numbers between the marks that a page has for them, if there is such a page.
void renew_page(const std::string& page, const std::string& name, const std::string& numbers) {
  std::string text = core::read_text(page);
  const std::string mark = "<!-- numbers of " + name + " -->\n";
  const auto begin = text.find(mark);
  const auto end = text.find("<!-- end -->", begin);
  if (begin == std::string::npos || end == std::string::npos)
    throw core::InputError(page + ": has no place for the " + mark);
  text.replace(begin + mark.size(), end - begin - mark.size(), numbers);
  core::write_file(page, text);
}

void make(const std::map<std::string, figures::Maker>& all, const std::string& name,
          const figures::Options& options, const std::string& folder, const std::string& page) {
  const auto maker = all.find(name);
  if (maker == all.end()) {
    std::string names;
    for (const auto& [known, unused] : all) names += (names.empty() ? "" : ", ") + known;
    throw core::InputError(fmt::format("no figure '{}'; there are {}", name, names));
  }
  const figures::Figure figure = maker->second(options);
  core::make_folder(folder);
  const std::string path = folder + (name.starts_with("table") ? "/" : "/figure-") + name + ".svg";
  results::write_svg(path, figure.panels, figure.caption);
  if (!page.empty()) renew_page(page, name, figure.text);
  fmt::print("{}\n{}\n{}: {:.0f} CPU s\n", figure.caption, figure.text, path,
             core::process_cpu_seconds() + core::children_cpu_seconds());
}

}  // namespace

int main(int argc, char** argv) {
  figures::Options options;
  options.worker = POLYSLIP_BINARY_DIR "/polyslip-mesher";
  std::vector<std::string> names;
  std::string folder = ".", page;
  CLI::App app("Plots that stand beside the paper's figures (docs/figures.md)");
  app.add_option("figures", names, "2, 3, 5 ... 11, table-1")->required();
  app.add_option("--to", folder, "Folder for figure-N.svg")->capture_default_str();
  app.add_option("--page", page, "Markdown page whose numbers are renewed");
  app.add_option("--grains", options.grains, "Grains of a cube");
  app.add_option("--cubes", options.cubes, "Number of cubes");
  app.add_option("--seed", options.seed, "Of the first cube")->capture_default_str();
  app.add_option("--element-size", options.element_size, "c_l")->capture_default_str();
  app.add_option("--jobs", options.jobs, "Worker processes; 0: one a core");
  app.add_option("--table", options.tables, "CSV files of mesh_quality, for table-1");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto all = all_figures();
    for (const std::string& name : names) make(all, name, options, folder, page);
  } catch (const core::InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    fmt::print(stderr, "paper_figures: {}\n", e.what());
    return 1;
  }
  return 0;
}

#include "results/report/report.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/names.hpp"
#include "results/report/figures.hpp"

namespace polyslip::results::report {
namespace {

namespace fs = std::filesystem;

const std::string mark = "<meta name=\"generator\" content=\"polyslip report\">";
const std::string place = "<!-- the data of the run -->";

/// A text between script tags may not end them.
std::string guarded(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.replace(at, 2, "<\\/");
  return text;
}

std::string read_page(const std::string& path) {
  if (!fs::exists(path))
    throw core::InputError(path +
                           ": no such file: this polyslip was built without the page of its "
                           "reports, which takes npm (docs/report.md)");
  return core::read_text(path);
}

void require_free(const std::string& path, bool overwrite) {
  if (!overwrite && fs::exists(path) && core::read_text(path).find(mark) == std::string::npos)
    throw core::InputError(path + ": is not a report of ours; move it, or give --overwrite");
}

}  // namespace

std::string write_report(const ReportRequest& request) {
  const std::string page = read_page(request.page);
  const std::string& folder = request.sources.folder;
  const std::string path = in_folder(folder, report_name);
  require_free(path, request.overwrite);
  const std::size_t at = page.find(place);
  if (at == std::string::npos || page.find(mark) == std::string::npos)
    throw core::InputError(request.page + ": is not the page of a report; build polyslip anew");
  const ReportData data = gather(request.sources);
  write_figures(in_folder(folder, figures_folder), data);
  core::FileWriter file(path);
  file.put(std::string_view(page).substr(0, at));
  file.put("<script type=\"application/json\" id=\"report-data\">" + guarded(json_text(data)) +
           "</script>\n");
  for (const Block& block : data.blocks)
    file.put("<script type=\"text/plain\" id=\"" + block.name + "\">" + block.text + "</script>\n");
  file.put(std::string_view(page).substr(at + place.size()));
  file.finish();
  return path;
}

std::string page_path() {
  return (fs::read_symlink("/proc/self/exe").parent_path() / "polyslip-report.html").string();
}

}  // namespace polyslip::results::report

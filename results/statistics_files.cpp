#include "results/statistics_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "core/error.hpp"
#include "core/file.hpp"
#include "mesh/topology.hpp"
#include "results/names.hpp"

namespace polyslip::results {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 10> file_names{"stats.json",   "grains.csv",
                                                 "faces.csv",    "edges.csv",
                                                 "elements.csv", "elements-histogram.csv",
                                                 "grains.svg",   "faces-and-edges.svg",
                                                 "elements.svg", "grain-meshes.svg"};

using Buffer = fmt::memory_buffer;

template <class... Args>
void add(Buffer& text, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
}

/// Row by row, so that a large table never stands in memory as text.
void write_table(const std::string& path, const std::string& header, long rows,
                 const std::function<void(Buffer&, long)>& add_row) {
  constexpr std::size_t chunk = 1 << 20;
  std::ofstream out(core::part_path(path), std::ios::binary | std::ios::trunc);
  Buffer text;
  text.append(header + "\n");
  for (long row = 0; row < rows; ++row) {
    add_row(text, row);
    if (text.size() > chunk) {
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
      text.clear();
    }
  }
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) {
    std::remove(core::part_path(path).c_str());
    throw core::InputError(path + ": cannot write; is the disk full?");
  }
  core::publish_part(path);
}

void write_grains(const std::string& path, const Statistics& s) {
  const bool meshed = !s.grain_meshes.empty();
  std::string header =
      "grain,inner,x,y,z,volume,diameter,area,sphericity,faces,edges,vertices,neighbours";
  if (meshed) header += ",elements,min_radius_ratio,mean_radius_ratio,mean_size,O_dis,O_size,O";
  write_table(path, header, s.grains, [&](Buffer& text, long row) {
    if (!s.counts(static_cast<int>(row))) return;
    const auto& g = s.measures.grains[row];
    add(text, "{},{:d},{},{},{},{},{},{},{},{},{},{},{}", s.grain_id(static_cast<int>(row)),
        g.inner, g.centroid.x(), g.centroid.y(), g.centroid.z(), g.volume, g.diameter(), g.area,
        g.sphericity(), g.faces, g.edges, g.vertices, g.neighbours);
    if (meshed) {
      const auto& m = s.grain_meshes[row];
      add(text, ",{},{},{},{},{},{},{}", m.elements, m.min_radius_ratio, m.mean_radius_ratio,
          m.mean_size, m.O_dis, m.O_size, m.O);
    }
    add(text, "\n");
  });
}

void write_faces(const std::string& path, const Statistics& s) {
  // The second grain is 0 on the domain boundary, and the domain's face has no name inside.
  write_table(
      path,
      "face,inner,grain_1,grain_2,domain_face,edges,area,diameter,flatness_fault,least_corner",
      std::ssize(s.measures.faces), [&](Buffer& text, long row) {
        const auto& f = s.measures.faces[row];
        if (!s.counts(f)) return;
        add(text, "{},{:d},{},{},{},{},{},{},{},{}\n", row + 1, f.inner, s.grain_id(f.cells[0]),
            f.cells[1] < 0 ? 0 : s.grain_id(f.cells[1]), s.domain_face_name(f.domain_face), f.edges,
            f.area, f.diameter(), f.flatness_fault, f.least_corner);
      });
}

void write_edges(const std::string& path, const Statistics& s) {
  write_table(path, "edge,inner,vertex_1,vertex_2,faces,length", std::ssize(s.measures.edges),
              [&](Buffer& text, long row) {
                const auto& e = s.measures.edges[row];
                if (!s.counts(e)) return;
                add(text, "{},{:d},{},{},{},{}\n", row + 1, e.inner, e.vertices[0] + 1,
                    e.vertices[1] + 1, e.faces, e.length);
              });
}

void write_elements(const std::string& path, const Statistics& s, const mesh::Mesh& mesh) {
  write_table(path, "element,grain,radius_ratio,size,relative_size", s.elements,
              [&](Buffer& text, long row) {
                const int grain = mesh.tetrahedron_cell[row];
                if (!s.counts(grain)) return;
                const auto m = mesh::measure_element(mesh, static_cast<int>(row));
                const long place = s.file_rows.empty() ? row : s.file_rows[row];
                add(text, "{},{},{:.6g},{:.6g},{:.6g}\n", place + 1, s.grain_id(grain),
                    m.radius_ratio, m.size, m.size / s.element_size(grain));
              });
}

void write_element_histogram(const std::string& path, const Statistics& s) {
  std::vector<std::pair<std::string, std::array<double, 3>>> rows;
  for (const char* key : {"radius_ratio", "relative_element_size"}) {
    const Histogram& h = s.quantity(key).histogram;
    for (int i = 0; i < static_cast<int>(h.counts.size()); ++i)
      rows.push_back({key, {h.edge(i), h.edge(i + 1), static_cast<double>(h.counts[i])}});
  }
  write_table(path, "quantity,from,to,elements", static_cast<long>(rows.size()),
              [&](Buffer& text, long row) {
                const auto& [key, r] = rows[row];
                add(text, "{},{:.6g},{:.6g},{:.0f}\n", key, r[0], r[1], r[2]);
              });
}

std::string with_unit(const Quantity& q) {
  if (q.unit == "degrees") return q.label + " [degrees]";
  if (q.unit == "L") return q.label + " (grains of unit mean volume)";
  return q.label;
}

std::string moments(const Quantity& q) {
  return fmt::format("mean {:.4g}, sd {:.3g}", q.distribution.mean, q.distribution.deviation);
}

Plot histogram_plot(const Statistics& s, const std::string& key, bool logarithmic = false) {
  const Quantity& q = s.quantity(key);
  Plot plot;
  plot.title = q.label + (logarithmic ? ", logarithmic" : "");
  plot.x.label = with_unit(q);
  plot.y.logarithmic = logarithmic;
  Series series = steps_of(q.histogram, moments(q));
  if (q.whole_numbers && q.histogram.width == 1) {
    series.mark = Mark::bars;
    series.x.pop_back();
    for (double& x : series.x) x += 0.5;
    plot.x.from = 0;
    plot.y.label = "share of grains";
  } else {
    plot.y.label = "probability density";
    plot.x.from = q.histogram.from;
    plot.x.to = q.histogram.edge(static_cast<int>(q.histogram.counts.size()));
  }
  plot.series.push_back(std::move(series));
  return plot;
}

Plot cumulative_plot(const Statistics& s, const std::string& key) {
  const Quantity& q = s.quantity(key);
  Plot plot;
  plot.title = q.label + ", cumulative";
  plot.x.label = with_unit(q);
  plot.y = {.label = "share below", .from = 0, .to = 1};
  Series series{fmt::format("90 % below {:.3g}", q.distribution.percentile(90))};
  series.y = q.histogram.cumulative();
  for (int i = 0; i < static_cast<int>(series.y.size()); ++i)
    series.x.push_back(q.histogram.edge(i));
  plot.x.from = series.x.front();
  plot.x.to = series.x.back();
  plot.series.push_back(std::move(series));
  return plot;
}

}  // namespace

std::vector<std::pair<std::string, std::vector<Plot>>> statistics_plots(const Statistics& s) {
  std::vector<std::pair<std::string, std::vector<Plot>>> plots{
      {"grains.svg",
       {histogram_plot(s, "grain_relative_diameter"), histogram_plot(s, "grain_sphericity"),
        histogram_plot(s, "grain_faces"), histogram_plot(s, "grain_neighbours")}},
      {"faces-and-edges.svg",
       {histogram_plot(s, "edge_length"), histogram_plot(s, "face_diameter"),
        histogram_plot(s, "face_flatness_fault"), cumulative_plot(s, "face_flatness_fault")}}};
  if (s.elements == 0) return plots;
  plots.push_back({"elements.svg",
                   {histogram_plot(s, "radius_ratio"), histogram_plot(s, "radius_ratio", true),
                    histogram_plot(s, "relative_element_size"),
                    histogram_plot(s, "relative_element_size", true)}});
  plots.push_back(
      {"grain-meshes.svg",
       {histogram_plot(s, "grain_O"), histogram_plot(s, "grain_O", true),
        histogram_plot(s, "grain_min_radius_ratio"), histogram_plot(s, "grain_elements")}});
  return plots;
}

void check_statistics_folder(const std::string& folder, bool overwrite) {
  fs::path existing = fs::absolute(folder).lexically_normal();
  std::error_code error;
  while (!fs::exists(existing, error) && existing != existing.root_path())
    existing = existing.parent_path();
  if (!fs::is_directory(existing, error))
    throw core::InputError(
        fmt::format("{}: {} is a file, not a folder; give another folder with "
                    "--to",
                    folder, existing.string()));
  core::require_writable_folder(existing.string());
  for (const char* name : file_names)
    if (!overwrite && fs::exists(in_folder(folder, name), error))
      throw core::InputError(
          fmt::format("{}: holds {} already; give another folder with --to, or "
                      "replace it with --overwrite",
                      folder, name));
}

std::vector<std::string> write_statistics(const std::string& folder, const Statistics& s,
                                          const mesh::Mesh* mesh, const std::string& source) {
  core::make_folder(folder);
  for (const char* name : file_names) {
    std::error_code error;
    fs::remove(in_folder(folder, name), error);
  }
  std::vector<std::string> names{"stats.json", "grains.csv", "faces.csv", "edges.csv"};
  write_grains(in_folder(folder, "grains.csv"), s);
  write_faces(in_folder(folder, "faces.csv"), s);
  write_edges(in_folder(folder, "edges.csv"), s);
  if (mesh != nullptr && s.elements <= element_rows_limit) {
    names.push_back("elements.csv");
    write_elements(in_folder(folder, names.back()), s, *mesh);
  } else if (mesh != nullptr) {
    names.push_back("elements-histogram.csv");
    write_element_histogram(in_folder(folder, names.back()), s);
  }
  for (const auto& [name, panels] : statistics_plots(s)) {
    write_svg(in_folder(folder, name), panels, "Statistics of " + source);
    names.push_back(name);
  }
  core::write_file(in_folder(folder, "stats.json"), json_text(s, source));
  return names;
}

}  // namespace polyslip::results

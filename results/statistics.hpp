#pragma once
// Statistics of a polycrystal and its mesh: which quantities there are, and their distributions.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/measures.hpp"
#include "results/distribution.hpp"
#include "results/regularisation_record.hpp"

namespace polyslip::results {

/// One quantity of all grains, faces, edges or elements that are counted.
struct Quantity {
  std::string key;         ///< as in stats.json: "grain_faces"
  std::string label;       ///< as in tables and plots: "faces per grain"
  std::string unit;        ///< "1", "degrees", "L" or "L^3": see docs/statistics.md
  std::string definition;  ///< a sentence
  bool whole_numbers = false;
  Distribution distribution;
  Histogram histogram{0, 1, 1};
  /// How many values lie below given bounds (radius ratios only).
  std::vector<std::pair<double, long>> counts_below;
};

/// Where c_l of eq. (7) comes from.
enum class ElementSizeSource { none, deck, option, mean };
std::string text_of(ElementSizeSource source);  ///< "the mean element", ...

struct StatisticsOptions {
  bool inner = false;                  ///< inner grains, and the faces and edges of these, only
  std::optional<double> element_size;  ///< c_l; the mean size of the elements if unknown
  ElementSizeSource element_size_source = ElementSizeSource::none;
  std::vector<double> element_sizes;  ///< [grain] where grains have a c_l of their own; or empty
};

struct Statistics {
  StatisticsOptions options;  ///< element_size is set if there is a mesh
  int grains = 0, inner_grains = 0;
  int faces = 0, edges = 0, vertices = 0;  ///< translates of a periodic polycrystal once
  long elements = 0, nodes = 0;            ///< 0 without a mesh
  std::vector<Quantity> quantities;
  std::optional<RegularisationRecord> regularisation;  ///< of a folder of polyslip run or mesh
  /// The file's own numbers of grains and elements, [grain] and [element]; empty: from 1.
  std::vector<int> grain_ids, file_rows;
  std::vector<std::string> domain_faces;  ///< names, as in Domain::faces; empty: numbers
  mesh::Measures measures;                ///< all, inner or not
  std::vector<mesh::GrainMeshMeasures> grain_meshes;  ///< [grain]; empty without a mesh
  double O_dis = 0, O_size = 0, O = 0;  ///< eqs. (6), (7), (5) over all elements that are counted

  /// c_l of a grain; there is a mesh.
  double element_size(int grain) const {
    return options.element_sizes.empty() ? *options.element_size : options.element_sizes[grain];
  }
  int grain_id(int grain) const { return grain_ids.empty() ? grain + 1 : grain_ids[grain]; }
  /// Name of a face of the domain; empty for -1, no face.
  std::string domain_face_name(int face) const;
  /// The quantity of that key; InternalError if there is none.
  const Quantity& quantity(const std::string& key) const;
  /// Whether a face or edge is one of those that are counted.
  template <class Entity>
  bool counts(const Entity& one) const {
    return !one.is_translate && (!options.inner || one.inner);
  }
  bool counts(int grain) const { return !options.inner || measures.grains[grain].inner; }
};

/// Measures of `mesh` may be those of a tessellation that it meshes: the same grains in the same
/// order; null: no mesh. InputError if only inner grains are asked for and there are none.
Statistics statistics_of(mesh::Measures measures, const mesh::Mesh* mesh,
                         const StatisticsOptions& options);

/// The table for the terminal.
std::string table_text(const Statistics& statistics, const std::string& source);

/// stats.json, schema "polyslip-stats/1".
std::string json_text(const Statistics& statistics, const std::string& source);

}  // namespace polyslip::results

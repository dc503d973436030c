#include "mesh/inp_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string_view>
#include <tuple>

#include "core/file.hpp"
#include "core/rotation.hpp"

namespace polyslip::mesh {
namespace {

/// Corners of the faces S1 ... S4 of a tetrahedron of Abaqus'.
constexpr std::array<std::array<int, 3>, 4> abaqus_faces{
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

std::array<int, 3> sorted(std::array<int, 3> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

class InpWriter {
 public:
  InpWriter(const Mesh& mesh, const std::string& path, const GrainNotes& notes)
      : mesh_(mesh), notes_(notes), out_(path), surfaces_(mesh.domain.surface_names()) {
    for (std::string& name : surfaces_)
      for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }

  void write() {
    out_.put("*HEADING\nPolycrystal\n");
    nodes();
    elements();
    node_sets();
    element_surfaces();
    for (std::size_t c = 0; c < notes_.orientations.size(); ++c) orientation(c);
    out_.finish();
  }

 private:
  void number(double x) {
    std::array<char, 32> digits;
    const auto end =
        std::to_chars(digits.begin(), digits.end(), x, std::chars_format::general, 13).ptr;
    out_.put(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
  }

  void nodes() {
    out_.put("*NODE, NSET=ALL_NODES\n");
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      out_.put(n + 1);
      for (int i = 0; i < 3; ++i) {
        out_.put(", ");
        number(mesh_.nodes[n][i]);
      }
      out_.put('\n');
    }
  }

  void elements() {
    constexpr std::array<int, 10> order{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
    const int corners = mesh_.order == 2 ? 10 : 4;
    int last = -1;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const int cell = mesh_.tetrahedron_cell[e];
      if (cell != last)
        out_.put(fmt::format("*ELEMENT, TYPE={}, ELSET=GRAIN{}\n",
                             mesh_.order == 2 ? "C3D10" : "C3D4", notes_.id(cell)));
      last = cell;
      out_.put(e + 1);
      for (int i = 0; i < corners; ++i) {
        out_.put(", ");
        out_.put(mesh_.tetrahedra[e][order[i]] + 1);
      }
      out_.put('\n');
    }
    out_.put(fmt::format("*ELSET, ELSET=ALL_GRAINS, GENERATE\n1, {}, 1\n", mesh_.element_count()));
  }

  int surface_of(std::size_t triangle) const {
    const int face = mesh_.topology.faces[mesh_.triangle_face[triangle]].domain_face;
    return face < 0 ? -1 : surface_of_face_[face];
  }

  void node_sets() {
    std::vector<char> marked(mesh_.nodes.size());
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      std::fill(marked.begin(), marked.end(), 0);
      for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
        if (surface_of(t) == static_cast<int>(s))
          for (const int n : mesh_.triangles[t])
            if (n >= 0) marked[n] = 1;
      out_.put(fmt::format("*NSET, NSET={}\n", surfaces_[s]));
      int column = 0;
      for (std::size_t n = 0; n < marked.size(); ++n) {
        if (!marked[n]) continue;
        if (column == 16) out_.put('\n'), column = 0;  // as many as a line may have
        if (column++ > 0) out_.put(", ");
        out_.put(n + 1);
      }
      out_.put('\n');
    }
  }

  struct Facet {
    std::array<int, 3> nodes;
    int surface;
    int element = 0, side = 0;
  };

  /// The triangles of the domain's surfaces with their tetrahedra.
  std::vector<Facet> facets() const {
    std::vector<Facet> found;
    std::vector<char> outside(mesh_.nodes.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const int surface = surface_of(t);
      if (surface < 0) continue;
      const auto& n = mesh_.triangles[t];
      found.push_back({sorted({n[0], n[1], n[2]}), surface});
      for (int i = 0; i < 3; ++i) outside[n[i]] = 1;
    }
    std::sort(found.begin(), found.end(),
              [](const Facet& a, const Facet& b) { return a.nodes < b.nodes; });
    for (int e = 0; e < mesh_.element_count(); ++e)
      for (int side = 0; side < 4; ++side) {
        std::array<int, 3> nodes;
        for (int i = 0; i < 3; ++i) nodes[i] = mesh_.tetrahedra[e][abaqus_faces[side][i]];
        if (!outside[nodes[0]] || !outside[nodes[1]] || !outside[nodes[2]]) continue;
        nodes = sorted(nodes);
        const auto at =
            std::lower_bound(found.begin(), found.end(), nodes,
                             [](const Facet& f, const auto& key) { return f.nodes < key; });
        if (at == found.end() || at->nodes != nodes) continue;
        at->element = e + 1;
        at->side = side + 1;
      }
    std::sort(found.begin(), found.end(), [](const Facet& a, const Facet& b) {
      return std::tie(a.surface, a.element, a.side) < std::tie(b.surface, b.element, b.side);
    });
    return found;
  }

  void element_surfaces() {
    int last = -1;
    for (const Facet& f : facets()) {
      if (f.surface != last)
        out_.put(fmt::format("*SURFACE, TYPE=ELEMENT, NAME=SURFACE_{}\n", surfaces_[f.surface]));
      last = f.surface;
      out_.put(f.element);
      out_.put(", S");
      out_.put(f.side);
      out_.put('\n');
    }
  }

  void orientation(std::size_t cell) {
    const core::Mat3 q = core::to_matrix(notes_.orientations[cell]);
    out_.put(fmt::format("*ORIENTATION, NAME=ORIENTATION_GRAIN{}, SYSTEM=RECTANGULAR\n",
                         notes_.id(static_cast<int>(cell))));
    for (int axis = 0; axis < 2; ++axis)
      for (int i = 0; i < 3; ++i) {
        if (axis + i > 0) out_.put(", ");
        number(q(i, axis));
      }
    out_.put('\n');
  }

  const Mesh& mesh_;
  const GrainNotes& notes_;
  core::FileWriter out_;
  std::vector<std::string> surfaces_;
  std::vector<int> surface_of_face_ = mesh_.domain.surface_of_face();
};

}  // namespace

void write_inp(const Mesh& mesh, const std::string& path, const GrainNotes& notes) {
  notes.check(mesh.topology.cell_count());
  InpWriter(mesh, path, notes).write();
}

}  // namespace polyslip::mesh

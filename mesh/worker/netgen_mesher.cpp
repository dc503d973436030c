// The only file that includes nglib.h. Debian's libnglib exports its functions in a namespace that
// its header does not open.

#include <cstddef>

namespace nglib {
#include <nglib.h>
}
namespace netgen {
extern int printmessage_importance;  // 0: silent
}

#include "mesh/worker/mesher.hpp"

namespace polyslip::mesh::worker {
namespace {

constexpr int optimisation_steps = 3;

class NetgenMesher : public Mesher {
 public:
  NetgenMesher(NetgenOptimiser optimiser, double share) : optimiser_(optimiser), share_(share) {}

  VolumeMesh fill(const SurfaceMesh& surface, double element_size) override {
    nglib::Ng_Mesh* grain = nglib::Ng_NewMesh();
    for (const auto& node : surface.nodes) {
      core::Vec3 x = node;
      nglib::Ng_AddPoint(grain, x.data());
    }
    for (const auto& triangle : surface.triangles) {
      std::array<int, 3> corners{triangle[0] + 1, triangle[1] + 1, triangle[2] + 1};
      nglib::Ng_AddSurfaceElement(grain, nglib::NG_TRIG, corners.data());
    }
    nglib::Ng_Meshing_Parameters parameters;
    parameters.maxh = share_ * element_size;
    parameters.optvolmeshenable = optimiser_ == NetgenOptimiser::own;
    parameters.optsteps_3d = optimiser_ == NetgenOptimiser::own ? optimisation_steps : 0;
    nglib::Ng_GenerateVolumeMesh(grain, &parameters);  // its return code is always "fine"
    VolumeMesh mesh = read_volume(grain);
    nglib::Ng_DeleteMesh(grain);
    mesh = without_unused_nodes(mesh, surface.nodes.size());
    // A mesh with a fault is judged as it is: Gmsh's optimiser would only hide its cause.
    return validate(surface, mesh).empty() ? optimise_with_gmsh(surface, mesh) : mesh;
  }

 private:
  /// Netgen's tetrahedra have the opposite sign to ours.
  static VolumeMesh read_volume(nglib::Ng_Mesh* grain) {
    VolumeMesh mesh;
    for (int i = 1; i <= nglib::Ng_GetNP(grain); ++i) {
      core::Vec3 x;
      nglib::Ng_GetPoint(grain, i, x.data());
      mesh.nodes.push_back(x);
    }
    for (int i = 1; i <= nglib::Ng_GetNE(grain); ++i) {
      std::array<int, NG_VOLUME_ELEMENT_MAXPOINTS> n{};
      nglib::Ng_GetVolumeElement(grain, i, n.data());
      mesh.tetrahedra.push_back({n[1] - 1, n[0] - 1, n[2] - 1, n[3] - 1});
    }
    return mesh;
  }

  NetgenOptimiser optimiser_;
  double share_;
};

}  // namespace

void initialise_netgen() {
  nglib::Ng_Init();
  netgen::printmessage_importance = 0;
}

std::unique_ptr<Mesher> make_netgen_mesher(NetgenOptimiser optimiser, double share) {
  return std::make_unique<NetgenMesher>(optimiser, share);
}

}  // namespace polyslip::mesh::worker

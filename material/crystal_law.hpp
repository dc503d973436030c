#pragma once
// The material at a point, in blocks of points. One virtual call serves many blocks.

#include <cstdint>
#include <memory>
#include <span>

#include "core/state_layout.hpp"
#include "core/types.hpp"

namespace polyslip::material {

/// Points of a block: innermost index of every array below.
inline constexpr int lanes = 4;

/// What a deck asks for in [material].
struct MaterialOptions {
  double c11 = 107.3e3, c12 = 60.9e3, c44 = 28.3e3;  ///< MPa
  double reference_slip_rate = 1.0;                  ///< gammadot0 [1/s]
  double rate_sensitivity = 0.12;                    ///< m of |tau/g|^(1/m)
  double g0 = 8.0, gs = 12.0, h0 = 4.0;              ///< MPa
};

/// not_finite: NaN or infinity in state or gradient. not_converged: det f <= 0 or no solution
/// found.
enum class PointStatus : std::uint8_t { converged = 0, not_converged = 1, not_finite = 2 };

/// Arrays of n_blocks blocks, lane innermost: array[block][component][lane].
struct PointBlocks {
  int n_blocks = 0;
  double time_step = 0;                       ///< s
  const double* relative_gradient = nullptr;  ///< [9] f_ij = d x_{n+1,i} / d x_{n,j}, row-major,
                                              ///< the law uses its isochoric part det(f)^(-1/3) f
  const double* state_old = nullptr;          ///< [layout().size()]
  double* state_new = nullptr;                ///< [layout().size()]
  double* stress = nullptr;       ///< [6] deviatoric Cauchy stress, Mandel order, sample
                                  ///< frame at n+1, MPa
  double* tangent = nullptr;      ///< [6*9] d stress_i / d h_kl, index 9 i + 3 k + l, with
                                  ///< h = df f^-1 = d(delta u_k)/d x_{n+1,l}; may be null
  PointStatus* status = nullptr;  ///< [1]
};

/// A crystal law: deviatoric response of a cubic crystal (pressure is decoupled; design page 2).
class CrystalLaw {
 public:
  virtual ~CrystalLaw() = default;
  virtual const core::StateLayout& layout() const = 0;
  /// K = (c11 + 2 c12)/3 [MPa]
  virtual double bulk_modulus() const = 0;
  /// Elastic shear modulus scale [MPa], an upper bound of the tangent, for scaling.
  virtual double shear_modulus() const = 0;
  /// Initial state of one point (lane-free: layout().size() doubles).
  virtual void initial_state(const core::Quaternion& orientation, double* state) const = 0;
  /// Backward-Euler update of every block; no allocation, no throw. Threads: OpenMP over blocks.
  /// A point whose status is not `converged` keeps its old state; its stress and tangent are zero.
  /// No result depends on threads or on the other points of a block.
  virtual void update(const PointBlocks& blocks) const = 0;
};

/// FCC crystal with 12 {111}<110> systems, power law (eq. 8) and Voce hardening (eq. 9).
/// Layout: "orientation" (4: w x y z), "elastic_strain" (5, crystal frame), "g" (1, MPa),
/// "slip" (1, sum over systems of |gamma|), "equivalent_strain" (1, integral of sqrt(2/3 Dp:Dp)).
/// Equations: docs/theory-material.md. Throws core::InputError if an option is out of its bounds.
std::unique_ptr<CrystalLaw> make_fcc_law(const MaterialOptions& options);

}  // namespace polyslip::material

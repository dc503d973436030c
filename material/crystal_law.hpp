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
  double voce_exponent = 1.0;                        ///< of (gs - g)/(gs - g0)
  double latent_ratio = 1.0;  ///< hardening by another system over that by the system itself
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

/// A crystal law: deviatoric response of a cubic crystal, whose pressure depends on the volume
/// alone. A hexagonal crystal couples the two unless c11 + c12 = c13 + c33. Its law would read the
/// volume from relative_gradient, whose determinant the cubic one drops, take the pressure of the
/// element as a further input, and return the derivatives of stress and volume strain with respect
/// to it; bulk_modulus() would then be that of Reuss, for scaling.
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

/// FCC crystal with 12 {111}<110> systems, power law (eq. 8) and Voce hardening (eq. 9):
/// g'_a = h0 ((gs - g_a)/(gs - g0))^voce_exponent sum_b q_ab |gamma'_b|, q_aa = 1 and q_ab =
/// latent_ratio for every other system b, coplanar ones too.
/// Layout: "orientation" (4: w x y z), "elastic_strain" (5, crystal frame), "g" (MPa; 1 component,
/// with a latent_ratio other than 1 the 12 g_a in the order of fcc_slip_systems(), all g0 at
/// first), "slip" (1, sum over systems of |gamma|), "equivalent_strain" (1, integral of sqrt(2/3
/// Dp:Dp)).
/// Equations: docs/theory-material.md. Throws core::InputError if an option is out of its bounds.
std::unique_ptr<CrystalLaw> make_fcc_law(const MaterialOptions& options);

}  // namespace polyslip::material

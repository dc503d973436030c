#pragma once
// Tangents that know the last change of the stress.
//
// Where slip changes from one system to another the power law is stiff on one side and soft on the
// other, and the tangent at the one end of an increment says little of the way between: Newton's
// method overshoots there and goes to and fro. From the second linearisation of a step on the law's
// tangent D is therefore corrected point by point (BFGS: Nocedal and Wright, Numerical
// Optimization, 2006, eq. 6.19; applied to the parts a function is the sum of: Griewank and Toint,
// Numer. Math. 39, 1982) so that it maps the last change of the gradients to that of the stress,
//   (S15)  D <- D - (D s)(D s)^T / (s . D s) + y y^T / (y . s),
// s the symmetric deviator of h = d(delta u)/dx, y the change of the deviatoric stress less what D
// makes of the rest of h (spin and volume). As increments become small y - D s falls with their
// square, and so does the correction.

namespace polyslip::solver {

/// (S15) of a block of four points. h: [9][4] of the last increment, entry 3 k + l; change: [6][4]
/// of the deviatoric stress in it, Mandel [MPa]; tangent: [54][4] of the law, corrected in place.
/// Points without y . s > 0 and s . D s > 0, and those with |y|^2 > stiffest y . s, are left alone:
/// no chord of a law that is nowhere stiffer than `stiffest` [MPa] can be that stiff.
void match_last_change(const double* h, const double* change, double stiffest, double* tangent);

}  // namespace polyslip::solver

#pragma once
// The tables of `polyslip analyse` as text: comma-separated, a header line, numbers in the shortest
// form that reads back to the same double; angles in degrees, densities in times random.

#include <string>

#include "results/analysis/analysis.hpp"
#include "results/analysis/texture_maps.hpp"

namespace polyslip::results::analysis {

/// strain,orientations,mean,texture_index
std::string index_csv(const Analysis& analysis);
/// strain,phi2,phi1_ideal,Phi_ideal,intensity_ideal,phi1_ridge,Phi_ridge,intensity_ridge
std::string beta_csv(const Analysis& analysis);
/// strain,grain,inner,counted,elements,volume,q0,q1,q2,q3,spread,deviation,largest,rotation,
/// bimodality
std::string spreads_csv(const Analysis& analysis);
/// strain,grains,mean,deviation,volume_mean,correlation
std::string spread_summary_csv(const Analysis& analysis);
/// phi1,Phi,phi2,density
std::string bunge_csv(const BungeGrid& grid);
/// r1,r2,r3,density within the fundamental region
std::string rodrigues_csv(const RodriguesGrid& grid);
std::string rodrigues_csv(const RodriguesSections& sections);
/// figure,x,y,density within the disc or the triangle of the equal-area projection
std::string pole_figure_rows(const DiscGrid& grid, const std::string& figure);
std::string inverse_pole_figure_rows(const TriangleGrid& grid, const std::string& figure);
inline const std::string pole_figure_header = "figure,x,y,density\n";
/// Options, textures and spread summaries, schema "polyslip-analysis/1".
std::string analysis_json(const Analysis& analysis);

}  // namespace polyslip::results::analysis

#pragma once
// The texture and microtexture of a run, a Taylor model, or a file of orientations, as numbers; the
// files of `polyslip analyse` are made of them (analysis_files.hpp).

#include <optional>
#include <string>
#include <vector>

#include "results/analysis/components.hpp"
#include "results/analysis/run_sample.hpp"
#include "results/analysis/spread.hpp"

namespace polyslip::results::analysis {

struct AnalysisOptions {
  double half_width = 0.17453292519943295;         ///< [rad] of the kernel; 10 degrees
  double fraction_angle = 0.2617993877991494;      ///< [rad] of volume fractions; 15 degrees
  SampleSymmetry symmetry = SampleSymmetry::none;  ///< of maps and the texture index
  bool inner = false;              ///< only grains without a face on the domain boundary
  bool one_mode = false;           ///< spreads: only grains of one mode at each strain but zero
  std::vector<double> at_strains;  ///< states nearest to these; empty: all
  int threads = 0;                 ///< 0: one a core
};

struct ComponentValue {
  std::string name;
  double intensity = 0;        ///< mean of the variants, times random
  double volume_fraction = 0;  ///< within fraction_angle
};

/// One state's texture.
struct TextureState {
  double strain = 0;
  long orientations = 0;
  std::vector<ComponentValue> components;
  OdfIntegrals integrals;
  std::vector<FibrePoint> beta;
};

/// Spreads over the grains of a state; grains count alike, angles in degrees.
struct SpreadSummary {
  double strain = 0;
  long grains = 0;         ///< that were counted
  double mean = 0;         ///< of the grains' spreads
  double deviation = 0;    ///< standard, over grains
  double volume_mean = 0;  ///< grains by their volumes
  double correlation = 0;  ///< with the state before; NaN at the first and from zero spread
};

struct Analysis {
  AnalysisOptions options;
  std::vector<RunSample> samples;      ///< by strain, those grains that count (see inner)
  std::vector<TextureState> textures;  ///< [samples]
  std::vector<std::vector<GrainSpread>> spreads;  ///< [samples][grains]; none of a Taylor model
  std::vector<bool> counted;                    ///< [grains] of the spreads' means: inner, one mode
  std::vector<SpreadSummary> spread_summaries;  ///< [samples], as spreads

  /// The orientations that make the texture of a state.
  Sample texture_sample(std::size_t state) const;
};

/// One state's texture.
TextureState texture_of(const Sample& sample, double strain, const AnalysisOptions& options);

/// Everything of a folder's stored states. InputError as chosen_states and read_run_sample, and if
/// no grain is inside though `inner` asks for them.
Analysis analyse_folder(const std::string& folder, const AnalysisOptions& options);

/// Of orientations from elsewhere: the texture only, at strain 0.
Analysis analyse_sample(Sample sample, const AnalysisOptions& options);

}  // namespace polyslip::results::analysis

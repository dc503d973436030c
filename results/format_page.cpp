#include "results/format_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/checksum.hpp"
#include "results/convert.hpp"
#include "results/macro_csv.hpp"
#include "results/schema.hpp"

namespace polyslip::results {
namespace {

constexpr const char* introduction = R"(# What a run leaves

This page is generated from the table in `results/schema.cpp` that writer and reader obey; a test
fails when the two differ.

| file | content |
|---|---|
| `deck.toml`, `deck.resolved.toml` | the deck as given, and with every default written out |
| `log.txt` | what happened |
| `macro.csv` | the macroscopic curve, one row a step |
| `results/state-0000.h5`, ... | stored states, one closed file each |
| `results.xdmf` | all of them as one time series for ParaView (XDMF Reader or Xdmf3ReaderT) |
| `results/index.json` | list of the stored states, from which `results.xdmf` is made |
| `checkpoints/checkpoint-0000.h5`, ... | the last two checkpoints; files of the same type |
| `remeshing-001.csv`, ... | what each remeshing changed, grain by grain |
| `mesh-000.msh`, ... | each mesh, Gmsh format 2.2 (others by `[output] mesh_formats`; formats.md) |
| `polycrystal.tess` | the regularised tessellation |
| `regularisation.json` | what the regularisation did: edges deleted and left, largest flatness fault in degrees, relative changes of the grains' volumes (rms, and whose is the worst) |
| `report.html`, `figures/` | all of it in one page, and its figures as files (report.md) |
| `polycrystal.png` | the undeformed and the deformed polycrystal in the paper's colours |
| `summary.json` | what came out, in numbers |
| `profile.txt`, `profile-petsc.txt` | with `--profile`: CPU and wall time of the deformation by stage, messages between ranks; the same stages in PETSc's own log |
| `texture.csv`, `spreads.csv`, `analysis/` | what `polyslip analyse` makes of it (texture.md) |

Files are written beside (`.part`) and renamed, so that a killed run leaves none of them half
written; `macro.csv` and `log.txt` grow line by line.

`polyslip taylor` leaves the same but for meshes, pictures, checkpoints and `results.xdmf`. Its states
have the root attribute `file_type` = "polyslip-orientations" and the datasets `time`, `strain`,
`mesh/grain` and those of `elements/`, a row an orientation; forces in `macro.csv`, and places in the
tables of `polyslip convert`, are nan. `summary.json` then has `taylor`: `initial_stress_over_g` and
`initial_slip_per_strain`, von Mises stress over g and the sum of |slip| per von Mises strain at the
initial orientations, elasticity being over, at a von Mises rate of reference_slip_rate.

## Conventions

x = RD, y = TD, z = ND, the direction of compression. Lengths (L) are such that grains have unit
mean volume; stresses are in MPa, forces in MPa L^2, strains and angles of rotations in radians.
Symmetric tensors are listed as xx yy zz yz zx xy, plain components in sample axes. A quaternion
(w, x, y, z) is that of the rotation that turns crystal axes into sample axes: its matrix has the
crystal axes, in sample components, as columns. Equivalent strain is the accumulated plastic one,
the integral of sqrt(2/3 Dp:Dp). Element and grain numbers start from 1 in tables (`mesh/grain`,
CSV files), all other indices from 0.

)";

constexpr const char* state_head = R"(## A stored state

An HDF5 file with the root attributes `file_type` = "{}" and `version` = {}. Its first {} bytes
are a text (HDF5's user block, which readers skip) with the length and the CRC-32 of all bytes that
follow, so that a truncated or altered file is recognised. Every state holds all that a restart
needs; a checkpoint is the same file. `h5py.File("results/state-0000.h5")["elements/g"][:]` is all
it takes to read one.

Sizes named by a word are the same wherever the word stands, but for `components` and `values`,
which each field has its own. Every dataset carries the attributes `unit` and `location`, those
below `state/` also `description`, `transport` (how it crosses a remeshing) and `index` (their
order).

Element values are means over the quadrature points, weighted by the points' shares of the current
volume; of orientations the eigenvector mean, with the sign of the element's first point, so that
they are continuous along a run. In the mixed element pressure is constant in an element.

| dataset | shape | type | unit | a row belongs to | content |
|---|---|---|---|---|---|
)";

constexpr const char* state_tail =
    R"(| `provenance/*` | scalar | text | - | file | Version, seed, hash of the deck, ... |

`results.xdmf` shows `mesh` (its own in each state), displacement, grain, orientation, colour, g,
slip, equivalent_strain, cauchy_stress (six columns in the order above) and pressure. Both sides of
a remeshing have the same time; so that readers keep both, that of the later one is shown larger by
1e-9 of itself. For the paper's colours choose `colour` and switch off "Map Scalars".

)";

constexpr const char* macro_text = R"(## macro.csv

    {}

One row a step, numbers in the shortest form that reads back to the same double. `strain` is the
path of the load, the accumulated magnitude of its strain, and `load_strain` that strain with its
sign; they are the same until a stage of the load goes back. The load's strain is ln(h0/h) in
compression and plane strain, ln(h/h0) in tension (h: the height along the axis of the load), the
shear gamma in simple shear, the integral of sqrt(2/3 D:D) under a velocity gradient, and
strain_rate times time under `faces`. Time in s, `step_size` the increment of the path; sxx ... sxy
the volume-average Cauchy stress in MPa; `fx_x0` ... `fz_z1` the x, y, z forces that the surroundings
exert on the body at its faces x0 ... z1, from reactions, in MPa L^2; iterations of the step, cut
attempts included; `remeshed` is 1 in the row of the first step after a remeshing. `load_stress` is
the mean normal stress along the axis, positive in the sense of the load, in simple shear the mean
shear stress, else the von Mises stress of the mean, in MPa.

## polyslip convert

    {}

One row an element, in the order of the mesh file of the state's mesh number: centroid, volume,
orientation quaternion q0 ... q3 = w x y z, slip resistance g, accumulated slip, equivalent strain,
stress, pressure. `--value average` (default): the element values above. `--value centroid`: the
value at the element's centroid: of fifteen quadrature points the one that lies there, else of the
linear function that fits the points best; quaternions likewise, normalised afterwards. An earlier
table is replaced, any other file with `--overwrite` only.

)";

constexpr const char* summary_text_page = R"(## summary.json

`schema` "polyslip-summary/1", `completed`, `final_strain`, `grains`, `elements_initial`,
`elements_final`, `nodes_initial`, `nodes_final`, `min_radius_ratio`, `mean_radius_ratio` (3 r_in /
R_circ of the corners' tetrahedron), `steps`, `step_cuts`, `newton_iterations`,
`linear_iterations`, `remeshings` (a list, below), `failed_remeshings` (a list of `strain` and `reason`:
the run stayed on the old mesh), `stress_final_mpa` (3x3, volume average), `cpu_s` by stage, `wall_s`, `peak_rss_mb`, `version`,
`seed`. What does not apply (`polyslip mesh` has no steps) is left out.

Of each remeshing: `strain`, `trigger` ("at_strains", "worn elements" or "failed step") and its `reason`
in words, `attempts` until it succeeded, `elements_before`, `elements_after`, `min_radius_ratio_before`,
`min_radius_ratio_after` (in the frame of sizes, docs/theory.md), `copied_faces`; over the grains, `max_grain_volume_change` and
`rms_grain_volume_change` (relative), `mean_grain_rotation` and `max_grain_rotation` (of their mean
orientations, degrees), `max_spread_change` (degrees); `before` and `after`, each with `mean_spread`
(mean over the grains of the volume-weighted mean angle from a grain's mean orientation, degrees), `g`
and `slip` (mean, least, largest), `elastic_energy` (MPa L^3), `volume` and `volume_at_zero_pressure`
(L^3); `stress_before` (von Mises stress of the volume average, MPa), `strain_to_reload` (until that stress is back at 99 % of it, null if it never
was), `reloaded_stress_ratio` (the stress 0.01 of strain later over the curve before, continued in a
straight line; null if the run or the mesh did not last so long).

## remeshing-001.csv

A row a grain, of the remeshing that made the mesh of that number: volume (L^3), rotation of its mean
orientation (degrees), spread (degrees), mean and extremes of g (MPa) and accumulated slip, elastic
energy (MPa L^3), volume at zero pressure (L^3), before and after. `before` is the deformed state,
`after` the same state on the new mesh, before its first step.
)";

const char* type_name(hdf5::Number type) {
  switch (type) {
    case hdf5::Number::float64:
      return "float64";
    case hdf5::Number::int32:
      return "int32";
    case hdf5::Number::uint8:
      return "uint8";
  }
  return "";
}

std::string table_row(const DatasetSpec& spec) {
  const std::string shape =
      spec.shape.empty() ? "scalar" : fmt::format("({})", fmt::join(spec.shape, ", "));
  return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", spec.name, shape, type_name(spec.type),
                     spec.unit.empty() ? "the field's" : spec.unit, spec.location,
                     spec.description);
}

}  // namespace

std::string results_format_page() {
  std::string page = introduction;
  page += fmt::format(state_head, state_file_type, state_file_version, header_size);
  for (const auto& spec : state_schema()) page += table_row(spec);
  page += state_tail;
  page += fmt::format(macro_text, macro_header, element_header);
  page += summary_text_page;
  return page;
}

}  // namespace polyslip::results

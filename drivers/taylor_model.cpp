#include "drivers/taylor_model.hpp"

#include <array>
#include <limits>

#include "core/error.hpp"
#include "core/tensor.hpp"

namespace polyslip::drivers {
namespace {

constexpr int row_size = 13;  // quaternion, g, slip, equivalent strain, six of the deviator

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int ranks_of(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size;
}

/// The first orientation of a rank; whole blocks of the law stay together, so that results do not
/// depend on the number of ranks.
int first_of(int count, int rank, int ranks) {
  constexpr int lanes = material::lanes;
  const long blocks = (count + lanes - 1) / lanes;
  return static_cast<int>(std::min<long>(count, blocks * rank / ranks * lanes));
}

double field_value(const material::PointDriver& points, const core::StateLayout& layout, int point,
                   const char* name, bool sum) {
  const int offset = layout.offset(name);
  if (offset < 0) throw core::InternalError(std::string("TaylorModel: no state ") + name);
  int components = 1;
  for (const auto& f : layout.fields)
    if (f.name == name) components = f.components;
  double total = 0;
  for (int i = 0; i < components; ++i) total += points.state(point, offset + i);
  return sum ? total : total / components;
}

}  // namespace

TaylorModel::TaylorModel(MPI_Comm comm, const material::CrystalLaw& law,
                         std::span<const core::Quaternion> orientations)
    : comm_(comm), law_(&law), count_(static_cast<int>(orientations.size())) {
  if (count_ == 0) throw core::InternalError("TaylorModel: no orientations");
  const int rank = rank_of(comm), ranks = ranks_of(comm);
  first_ = first_of(count_, rank, ranks);
  const int last = first_of(count_, rank + 1, ranks);
  if (last > first_)
    part_.emplace_back(law, orientations.subspan(static_cast<std::size_t>(first_),
                                                 static_cast<std::size_t>(last - first_)));
}

long TaylorModel::deform(const core::Mat3& relative_gradient, double time_step) {
  std::vector<material::PointDriver> trial = part_;
  long failed = 0;
  for (auto& points : trial) failed += points.deform(relative_gradient, time_step);
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_LONG, MPI_SUM, comm_);
  if (failed == 0) part_ = std::move(trial);
  return failed;
}

core::Vec6 TaylorModel::mean_deviator() const {
  core::Vec6 sum = core::Vec6::Zero();
  for (const auto& points : part_) sum += points.mean_stress() * points.size();
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 6, MPI_DOUBLE, MPI_SUM, comm_);
  return sum / count_;
}

double TaylorModel::mean_state(const char* field, bool sum) const {
  double total = 0;
  for (const auto& points : part_)
    for (int i = 0; i < points.size(); ++i)
      total += field_value(points, law_->layout(), i, field, sum);
  MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, comm_);
  return total / count_;
}

double TaylorModel::mean_strength() const { return mean_state("g", false); }
double TaylorModel::mean_slip() const { return mean_state("slip", true); }

results::ElementTable TaylorModel::table(double mean_stress) const {
  std::vector<double> rows;
  for (const auto& points : part_)
    for (int i = 0; i < points.size(); ++i) {
      const core::Quaternion q = points.orientation(i);
      const core::Mat3 s = core::from_mandel(points.stress(i));
      rows.insert(rows.end(),
                  {q.w(), q.x(), q.y(), q.z(), field_value(points, law_->layout(), i, "g", false),
                   field_value(points, law_->layout(), i, "slip", true),
                   field_value(points, law_->layout(), i, "equivalent_strain", true), s(0, 0),
                   s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1)});
    }
  const int ranks = ranks_of(comm_);
  std::vector<int> counts(static_cast<std::size_t>(ranks)), starts(counts);
  for (int r = 0; r < ranks; ++r) {
    const auto at = static_cast<std::size_t>(r);
    starts[at] = row_size * first_of(count_, r, ranks);
    counts[at] = row_size * first_of(count_, r + 1, ranks) - starts[at];
  }
  const bool root = rank_of(comm_) == 0;
  std::vector<double> all(root ? static_cast<std::size_t>(row_size) * count_ : 0);
  MPI_Gatherv(rows.data(), static_cast<int>(rows.size()), MPI_DOUBLE, all.data(), counts.data(),
              starts.data(), MPI_DOUBLE, 0, comm_);
  results::ElementTable t;
  constexpr double unset = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < all.size(); i += row_size) {
    const double* v = &all[i];
    t.volume.push_back(1);
    t.centroid.push_back(core::Vec3::Constant(unset));
    t.orientation.emplace_back(v[0], v[1], v[2], v[3]);
    t.g.push_back(v[4]);
    t.slip.push_back(v[5]);
    t.equivalent_strain.push_back(v[6]);
    core::Vec6 stress = Eigen::Map<const core::Vec6>(v + 7);
    stress.head<3>().array() += mean_stress;
    t.cauchy_stress.push_back(stress);
    t.pressure.push_back(-mean_stress);
  }
  return t;
}

}  // namespace polyslip::drivers

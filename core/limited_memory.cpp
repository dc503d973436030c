#include "core/limited_memory.hpp"

#include <algorithm>
#include <deque>

namespace polyslip::core {
namespace {

using Eigen::VectorXd;

constexpr int max_halvings = 20;
constexpr double sufficient_descent = 1e-4;  // Armijo
constexpr double least_curvature = 1e-10;    // of a pair that is kept, relative

struct Pair {
  VectorXd step, change;
  double inverse_product;
};

class Memory {
 public:
  explicit Memory(int size) : size_(size) {}
  bool empty() const { return pairs_.empty(); }
  void forget() { pairs_.clear(); }

  void keep(const VectorXd& step, const VectorXd& change) {
    const double product = step.dot(change);
    if (!(product > least_curvature * step.norm() * change.norm())) return;
    pairs_.push_back({step, change, 1 / product});
    if (static_cast<int>(pairs_.size()) > size_) pairs_.pop_front();
  }

  /// The two-loop recursion; with no pair, steepest descent.
  VectorXd direction(const VectorXd& gradient) const {
    VectorXd d = -gradient;
    if (pairs_.empty()) return d;
    std::vector<double> parts(pairs_.size());
    for (std::size_t k = pairs_.size(); k-- > 0;) {
      parts[k] = pairs_[k].inverse_product * pairs_[k].step.dot(d);
      d -= parts[k] * pairs_[k].change;
    }
    d /= pairs_.back().inverse_product * pairs_.back().change.squaredNorm();
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      d += (parts[k] - pairs_[k].inverse_product * pairs_[k].change.dot(d)) * pairs_[k].step;
    return d;
  }

 private:
  int size_;
  std::deque<Pair> pairs_;
};

}  // namespace

VectorXd minimise(VectorXd x,
                  const std::function<std::optional<ValueAndGradient>(const VectorXd&)>& evaluate,
                  const std::function<void()>& accept, const std::function<bool(int)>& stop,
                  const LimitedMemoryOptions& options) {
  auto now = evaluate(x);
  if (!now) return x;
  accept();
  Memory memory(options.memory);
  for (int iteration = 0; iteration < options.max_iterations && !stop(iteration);) {
    VectorXd direction = memory.direction(now->gradient);
    if (!(direction.dot(now->gradient) < 0)) {
      if (memory.empty()) return x;
      memory.forget();
      continue;
    }
    const double largest = direction.lpNorm<Eigen::Infinity>();
    double step = memory.empty() ? options.first_step / largest
                                 : std::min(1.0, options.largest_step / largest);
    bool descended = false;
    for (int i = 0; i < max_halvings && !descended; ++i, step /= 2) {
      const VectorXd next = x + step * direction;
      auto then = evaluate(next);
      const double wanted = now->value + sufficient_descent * step * direction.dot(now->gradient);
      if (!then || !(then->value < wanted)) continue;
      accept();
      memory.keep(next - x, then->gradient - now->gradient);
      x = next;
      now = std::move(then);
      descended = true;
    }
    if (descended) {
      ++iteration;
    } else {
      if (memory.empty()) return x;
      memory.forget();
    }
  }
  return x;
}

}  // namespace polyslip::core

#pragma once
// Many weighted unit vectors gathered in small cells, so that a sum of a smooth function of
// p . x over all of them is a sum over the cells:
//   sum_i w_i f(p . x_i)  =  W f(p . c) + 1/2 f''(p . c) p . M p  per cell,
// with its weight W, mean c and second moment M = sum w (x - c)(x - c)^T about the mean. The first
// order vanishes by the choice of c, the error is of third order in the cell's size; a cell with
// one vector is exact. Cells are gathered in groups with a bounding cone, so that a kernel of
// bounded support skips what it does not reach.

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

namespace polyslip::results::analysis {

/// Where a cell or group lies in a grid that the caller lays over the vectors.
using CellKey = std::array<int, 3>;

template <int D>
class MomentCells {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;
  using Matrix = Eigen::Matrix<double, D, D>;

  /// keys[i]: cell of vector i; a group has the cells whose keys agree after division (rounded
  /// down) by `group`.
  MomentCells(const std::vector<Vector>& vectors, const std::vector<double>& weights,
              const std::vector<CellKey>& keys, int group) {
    std::map<CellKey, std::map<CellKey, std::vector<std::size_t>>> sorted;
    for (std::size_t i = 0; i < vectors.size(); ++i)
      if (weights[i] > 0) sorted[group_of(keys[i], group)][keys[i]].push_back(i);
    for (const auto& [key, members] : sorted) {
      Group g;
      g.first = cells_.size();
      for (const auto& [cell, indices] : members)
        cells_.push_back(gather(vectors, weights, indices));
      g.last = cells_.size();
      bound(g);
      groups_.push_back(g);
    }
  }

  /// Sum over all vectors of a function f that vanishes where |p . x| < least (`even`), or where
  /// p . x < least; p: a unit vector. f(t, second) returns f(t) and sets f''(t).
  template <bool even, class Function>
  double sum(const Vector& p, double least, const Function& f) const {
    double total = 0;
    const double reach = std::acos(std::min(least, 1.0));
    for (const Group& g : groups_) {
      const double cosine = even ? std::abs(p.dot(g.axis)) : p.dot(g.axis);
      if (cosine < std::cos(std::min(reach + g.opening, 3.14159))) continue;
      for (std::size_t i = g.first; i < g.last; ++i) {
        const Cell& c = cells_[i];
        const double t = p.dot(c.mean);
        if ((even ? std::abs(t) : t) < least) continue;
        double second = 0;
        const double value = f(t, second);
        total += c.weight * value + 0.5 * second * p.dot(c.moment * p);
      }
    }
    return total;
  }

  std::size_t size() const { return cells_.size(); }

 private:
  struct Cell {
    double weight = 0;
    Vector mean = Vector::Zero();
    Matrix moment = Matrix::Zero();
  };
  struct Group {
    std::size_t first = 0, last = 0;
    Vector axis = Vector::Zero();
    double opening = 0;  ///< [rad] largest angle of a cell's mean from the axis
  };

  static CellKey group_of(const CellKey& key, int group) {
    CellKey result;
    for (std::size_t i = 0; i < 3; ++i)
      result[i] = key[i] >= 0 ? key[i] / group : -((-key[i] + group - 1) / group);
    return result;
  }

  static Cell gather(const std::vector<Vector>& vectors, const std::vector<double>& weights,
                     const std::vector<std::size_t>& indices) {
    Cell c;
    for (const std::size_t i : indices) {
      c.weight += weights[i];
      c.mean += weights[i] * vectors[i];
    }
    c.mean /= c.weight;
    for (const std::size_t i : indices) {
      const Vector d = vectors[i] - c.mean;
      c.moment += weights[i] * d * d.transpose();
    }
    return c;
  }

  void bound(Group& g) const {
    for (std::size_t i = g.first; i < g.last; ++i) g.axis += cells_[i].mean;
    g.axis.normalize();
    for (std::size_t i = g.first; i < g.last; ++i) {
      const double cosine = g.axis.dot(cells_[i].mean) / cells_[i].mean.norm();
      g.opening = std::max(g.opening, std::acos(std::min(cosine, 1.0)));
    }
  }

  std::vector<Cell> cells_;
  std::vector<Group> groups_;
};

}  // namespace polyslip::results::analysis

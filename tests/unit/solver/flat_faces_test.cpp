// How far a body lies beyond the planes of its dies.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/model.hpp"
#include "support/box_mesh.hpp"
#include "support/crystal_boxes.hpp"
#include "support/elastic_law.hpp"

namespace polyslip::solver {
namespace {

/// A box of 2 x 1.5 x 1.2 in three layers of elements, which the load of this type says to be
/// 1.2 exp(-strain) high.
FlowPast past(const LoadingOptions& loading, double strain) {
  const tests::ElasticLaw law(30, 100);
  mesh::Snapshot box;
  if (tests::on_root(MPI_COMM_WORLD)) {
    box = initial_snapshot(tests::box_mesh({4, 3, 3}, {2, 1.5, 1.2}, 2),
                           {core::Quaternion::Identity(), core::Quaternion::Identity()}, law);
    box.strain = strain;
  }
  return Model(MPI_COMM_WORLD, std::move(box), law, loading, {}, {}).past_flat_faces();
}

TEST(FlatFaces, SeeWhatLiesBeyondThem) {
  // Of the nodes that are not on z1 the mid nodes of the highest layer are at 1.0.
  const FlowPast p = past({}, std::log(1.2 / 0.9));
  EXPECT_EQ(p.face, 5);
  EXPECT_NEAR(p.distance, 0.1 / 1.2, 1e-12);
}

TEST(FlatFaces, SeeNothingBeyondThoseThatBoundTheBody) {
  for (const double strain : {0.0, std::log(1.2 / 1.1)}) {
    const FlowPast p = past({}, strain);
    EXPECT_EQ(p.face, -1);
    EXPECT_EQ(p.distance, 0);
  }
}

TEST(FlatFaces, AreNoneWhereTheWholeBoundaryIsPrescribed) {
  LoadingOptions shear;
  shear.type = "simple-shear";
  EXPECT_EQ(past(shear, 0.3).face, -1);
}

}  // namespace
}  // namespace polyslip::solver

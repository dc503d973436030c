#include "solver/petsc_handle.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "core/error.hpp"
#include "solver/petsc_session.hpp"

namespace polyslip::solver {
namespace {

PetscInt references(Vec v) {
  PetscInt count = 0;
  check(PetscObjectGetReference(reinterpret_cast<PetscObject>(v), &count));
  return count;
}

TEST(PetscHandle, OwnsSharesAndMovesByExchange) {
  VecHandle a;
  EXPECT_FALSE(a);
  check(VecCreateSeq(PETSC_COMM_SELF, 3, a.out()));
  ASSERT_TRUE(a);
  EXPECT_EQ(references(a.get()), 1);
  {
    const VecHandle b = VecHandle::share(a.get());
    EXPECT_EQ(references(a.get()), 2);
  }
  EXPECT_EQ(references(a.get()), 1);
  const Vec raw = a.get();
  VecHandle c(std::move(a));
  EXPECT_EQ(c.get(), raw);
  VecHandle d;
  d = std::move(c);
  EXPECT_EQ(d.get(), raw);
  d.reset();
  EXPECT_FALSE(d);
}

TEST(PetscHandle, ErrorsBecomeInternalErrorsThatNameThePlace) {
  VecHandle a;
  check(VecCreateSeq(PETSC_COMM_SELF, 3, a.out()));
  VecHandle b;
  check(VecCreateSeq(PETSC_COMM_SELF, 4, b.out()));
  try {
    check(VecCopy(a.get(), b.get()));
    FAIL() << "sizes 3 and 4 were accepted";
  } catch (const core::InternalError& error) {
    EXPECT_NE(std::string(error.what()).find("petsc_handle_test.cpp"), std::string::npos);
  }
  EXPECT_THROW(PetscSession second, core::InternalError);
}

}  // namespace
}  // namespace polyslip::solver

#include "solver/profile.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/file.hpp"
#include "solver/exchange.hpp"
#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

void spin(double seconds) {
  const double end = MPI_Wtime() + seconds;
  while (MPI_Wtime() < end) {
  }
}

TEST(Profile, NestedStagesAreBookedApart) {
  Profile profile;
  {
    const Stage outer(&profile, "outer");
    for (int i = 0; i < 3; ++i) {
      const Stage inner(&profile, "inner");
      spin(0.02);
    }
  }
  ASSERT_EQ(profile.entries().size(), 2u);
  const auto& inner = profile.entries()[0];
  const auto& outer = profile.entries()[1];
  EXPECT_EQ(inner.stage, "inner");
  EXPECT_EQ(inner.calls, 3);
  EXPECT_GE(inner.wall, 0.06);
  EXPECT_EQ(outer.calls, 1);
  EXPECT_LT(outer.wall, 0.5 * inner.wall);
  profile.clear();
  EXPECT_TRUE(profile.entries().empty());
}

/// Two steps of four slabs; the profile changes no number.
TEST(Profile, SaysWhatAModelDidWithoutChangingIt) {
  const auto law = material::make_fcc_law({});
  const auto start = tests::slab_box(MPI_COMM_WORLD, *law);
  Profile profile;
  Model watched(MPI_COMM_WORLD, start, *law, {}, {}, {}, &profile);
  Model plain(MPI_COMM_WORLD, start, *law, {}, {}, {});
  for (int i = 0; i < 2; ++i) EXPECT_EQ(watched.step(1).stress, plain.step(1).stress);
  const std::string text = profile_text(profile, MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    for (const char* stage : {"material", "smoother", "vertex level", "operator"})
      EXPECT_NE(text.find(stage), std::string::npos) << stage << '\n' << text;
  } else {
    EXPECT_TRUE(text.empty());
  }
  EXPECT_EQ(profile.messages() > 0, size_of(MPI_COMM_WORLD) > 1);
  EXPECT_EQ(profile.bytes() > 0, size_of(MPI_COMM_WORLD) > 1);
}

TEST(Profile, IsAlsoPetscsLog) {
  Profile profile;
  profile.log_with_petsc();
  {
    const Stage outer(&profile, "outer of PETSc");
    const Stage inner(&profile, "inner of PETSc");
  }
  const std::string path = (std::filesystem::temp_directory_path() /
                            fmt::format("polyslip-petsc-log-{}.txt", size_of(MPI_COMM_WORLD)));
  write_petsc_log(path);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    const std::string text = core::read_text(path);
    EXPECT_NE(text.find("inner of PETSc"), std::string::npos) << text.substr(0, 4000);
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace polyslip::solver

#include "drivers/orientations.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/random.hpp"
#include "core/rotation.hpp"

namespace polyslip::drivers {
namespace {

class OrientationFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::vector<core::Quaternion> read(const std::string& text, const std::string& convention,
                                     int count) {
    core::write_file(path_, text);
    return read_orientations(path_, convention, count);
  }
  /// The error without the path in front.
  std::string error_of(const std::string& text, int count,
                       const std::string& convention = "quaternion") {
    try {
      read(text, convention, count);
    } catch (const core::InputError& error) {
      const std::string what = error.what();
      return what.rfind(path_, 0) == 0 ? what.substr(path_.size()) : what;
    }
    return "no error";
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / ("polyslip_ori_" + std::to_string(::getpid())))
          .string();
};

double distance(const core::Quaternion& a, const core::Quaternion& b) {
  return core::rotation_angle(a.conjugate() * b);
}

TEST_F(OrientationFile, TheThreeConventionsMeanTheSame) {
  core::Random random(1, core::Stream::tests);
  std::vector<core::Quaternion> expected;
  std::string quaternions = "# w x y z\n\n", rodrigues, euler;
  for (int i = 0; i < 20; ++i) {
    const core::Quaternion q = random.rotation();
    const core::Vec3 r = core::to_rodrigues(q), e = core::to_bunge(q);
    expected.push_back(q);
    quaternions +=
        fmt::format("{} {}\t{} +{} # grain {}\n", q.w(), q.x(), q.y(), std::abs(q.z()), i);
    expected.back().z() = std::abs(q.z());
    rodrigues += fmt::format("{} {} {}\r\n", r[0], r[1], r[2]);
    euler += fmt::format("  {} {} {}\n", e[0], e[1], e[2]);
  }
  const auto a = read(quaternions, "quaternion", 20);
  const auto b = read(rodrigues, "rodrigues", 20);
  const auto c = read(euler, "euler-bunge", 20);
  core::Random again(1, core::Stream::tests);
  for (std::size_t i = 0; i < 20; ++i) {
    const core::Quaternion q = again.rotation();
    EXPECT_LT(distance(a[i], expected[i]), 1e-14);
    EXPECT_LT(distance(b[i], q), 1e-13);
    EXPECT_LT(distance(c[i], q), 1e-13);
  }
}

TEST_F(OrientationFile, KnownOrientation) {
  // Bunge (90, 0, 0): the crystal's [100] lies along y.
  const auto q = read("90 0 0", "euler-bunge", 1);
  EXPECT_LT((q[0] * core::Vec3::UnitX() - core::Vec3::UnitY()).norm(), 1e-15);
}

TEST_F(OrientationFile, ErrorsNameTheLine) {
  EXPECT_EQ(error_of("1 0 0 0\n# c\n1 0 0\n", 2), ":3: 3 numbers, must be 4 (quaternion: w x y z)");
  EXPECT_EQ(error_of("0 0 0 0\n", 1, "euler-bunge"),
            ":1: 4 numbers, must be 3 (euler-bunge: phi1 Phi phi2 in degrees)");
  EXPECT_EQ(error_of("1 0 0 x0\n", 1), ":1: 'x0' is not a number");
  EXPECT_EQ(error_of("1, 0 0 0\n", 1), ":1: '1,' is not a number");
  EXPECT_EQ(error_of("1 0 0 nan\n", 1), ":1: nan is not finite");
  EXPECT_EQ(error_of("inf 0 0\n", 1, "rodrigues"), ":1: inf is not finite");
  EXPECT_EQ(error_of("1 0 0 1\n", 1),
            ":1: the quaternion's length is 1.41421, must be 1 within 0.001");
  EXPECT_EQ(error_of("0 0 0 0\n", 1), ":1: the quaternion's length is 0, must be 1 within 0.001");
}

TEST_F(OrientationFile, ErrorsOfTheCount) {
  EXPECT_EQ(error_of("1 0 0 0\n1 0 0 0\n", 1),
            ":2: more orientations than the 1 grains of the deck");
  EXPECT_EQ(error_of("1 0 0 0\n\n", 2), ":2: ends after 1 of 2 orientations, one a grain");
  EXPECT_EQ(error_of("", 2), ":1: ends after 0 of 2 orientations, one a grain");
}

TEST_F(OrientationFile, RoundedQuaternionsAreNormalised) {
  const auto q = read("0.5001 0.5 0.5 0.5", "quaternion", 1);
  EXPECT_NEAR(q[0].norm(), 1, 1e-15);
}

TEST(UniformOrientations, DependOnTheSeedAloneAndKeepTheirFirst) {
  const auto few = uniform_orientations(1, 10), many = uniform_orientations(1, 20);
  const auto other = uniform_orientations(2, 10);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(few[i].coeffs(), many[i].coeffs());
    EXPECT_GT(distance(few[i], other[i]), 1e-3);
  }
}

TEST(GrainOrientations, FollowTheDeck) {
  Options options;
  options.polycrystal.grains = 5;
  options.polycrystal.seed = 3;
  const auto q = grain_orientations(options);
  ASSERT_EQ(q.size(), 5u);
  EXPECT_EQ(q[4].coeffs(), uniform_orientations(3, 5)[4].coeffs());
  options.orientations.file = "/no/such/file";
  EXPECT_THROW(grain_orientations(options), core::InputError);
}

TEST(GrainOrientations, AreDrawnFromTheComponentsOfTheDeck) {
  const std::string text =
      "[polycrystal]\ngrains = 40\nseed = 5\n[orientations]\ndistribution = \"components\"\n"
      "[[orientations.component]]\nname = \"brass\"\nhalf_width = 0\n"
      "[[orientations.component]]\ntype = \"fibre\"\ncrystal = [1, 1, 1]\nsample = [0, 0, 1]\n"
      "half_width = 0\nshare = 2\n"
      "[[orientations.component]]\neuler = [90, 0, 0]\nhalf_width = 0\n";
  core::Deck deck = core::Deck::from_text(text, "deck.toml");
  const Options options = read_options(deck);
  const auto orientations = grain_orientations(options);
  ASSERT_EQ(orientations.size(), 40U);
  int brass = 0, fibre = 0, euler = 0;
  for (const auto& q : orientations) {
    brass += (q * core::Vec3(0, 1, 1).normalized() - core::Vec3::UnitZ()).norm() < 1e-12;
    fibre += (q * core::Vec3(1, 1, 1).normalized() - core::Vec3::UnitZ()).norm() < 1e-12;
    euler += (q * core::Vec3::UnitX() - core::Vec3::UnitY()).norm() < 1e-12;
  }
  EXPECT_EQ(brass, 10);
  EXPECT_EQ(fibre, 20);
  EXPECT_EQ(euler, 10);
  // The deck as it was understood draws the same.
  core::Deck again = core::Deck::from_text(deck.resolved(), "resolved.toml");
  const auto same = grain_orientations(read_options(again));
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(same[i].coeffs(), orientations[i].coeffs());
}

TEST_F(OrientationFile, WeightsMayFollow) {
  core::write_file(path_, "# phi1 Phi phi2 weights\n10 20 30 0.25\n40 50 60 0.75\n");
  EXPECT_EQ(convention_of_file(path_), "euler-bunge");
  const auto read = read_weighted_orientations(path_, "euler-bunge");
  EXPECT_EQ(read.weights, (std::vector<double>{0.25, 0.75}));
  ASSERT_EQ(read.orientations.size(), 2u);
  EXPECT_LT(distance(read.orientations[1], core::from_bunge({40, 50, 60})), 1e-12);
  core::write_file(path_, "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  EXPECT_EQ(convention_of_file(path_), "quaternion");
  EXPECT_EQ(read_weighted_orientations(path_, "quaternion").weights, std::vector<double>(3, 1.0));
}

TEST_F(OrientationFile, WeightsAreInAllLinesOrNone) {
  for (const char* text : {"1 0 0 0 2\n1 0 0 0\n", "1 0 0 0\n1 0 0 0 2\n", "1 0 0 0 -1\n",
                           "1 0 0 0 nan\n", "1 0 0 0 0\n", "", "1 0 0 0 1 1\n"}) {
    core::write_file(path_, text);
    EXPECT_THROW(read_weighted_orientations(path_, "quaternion"), core::InputError) << text;
  }
}

}  // namespace
}  // namespace polyslip::drivers

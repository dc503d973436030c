#include "mesh/orientation_block.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/random.hpp"
#include "core/rotation.hpp"
#include "unit/mesh/reader_support.hpp"

namespace polyslip::mesh {
namespace {

core::Quaternion read(const std::string& text) {
  TextScanner in("ori", text);
  const OrientationDescriptor descriptor = read_orientation_descriptor(in);
  const core::Quaternion q = read_orientation(in, descriptor);
  EXPECT_EQ(in.peek(), "");
  return q;
}

std::string fault(const std::string& text) {
  try {
    read(text);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

double distance(const core::Quaternion& a, const core::Quaternion& b) {
  return core::rotation_angle(a.conjugate() * b);
}

// The orientations of two grains as Neper 4 tabulates them, in each of its descriptors
// (-statelset rodrigues:passive,quaternion,euler-bunge:active,...; nothing means active).
TEST(OrientationBlock, NepersDescriptorsOfOneCrystalMeanTheSame) {
  const std::vector<std::vector<std::string>> crystals = {
      {"rodrigues:passive 2.444015198417 -0.618305125773 -2.829029762200",
       "rodrigues:active -2.444015198417 0.618305125773 2.829029762200",
       "quaternion 0.255164144719 -0.623625047785 0.157769298594 0.721866959658",
       "euler-bunge:active 236.335386748000 80.072535051271 -95.270156451542",
       "euler-kocks 146.335386748000 80.072535051271 185.270156451542",
       "euler-roe:active 146.335386748000 80.072535051271 354.729843548458",
       "axis-angle -0.644975177248 0.163170612993 0.746580452322 150.433376578065",
       "rotmat -0.091966118048 0.171611357976 -0.980862770700 -0.565166903474 -0.820000215342 "
       "-0.090476616082 -0.819834498145 0.546030391694 0.172401296392"},
      {"rodrigues:passive -0.441042954395 -0.731096527047 0.307369633254",
       "quaternion:active 0.740538189917 0.326609151123 0.541404898794 -0.227618951845",
       "euler-bunge 41.813165532958 78.438807181812 -75.984842545414",
       "euler-kocks:active 311.813165532958 78.438807181812 165.984842545414",
       "euler-roe 311.813165532958 78.438807181812 14.015157454586",
       "axis-angle:active 0.486015196430 0.805644934720 -0.338711481941 84.445437417174",
       "rotmat:active 0.310140696646 0.016534535637 -0.950546872813 0.690776641999 0.683032150327 "
       "0.237265067991 0.653177142246 -0.730201130341 0.200414395929"}};
  for (const auto& texts : crystals) {
    const core::Quaternion expected = read(texts[0]);
    for (const std::string& text : texts) EXPECT_LT(distance(read(text), expected), 1e-9) << text;
  }
}

TEST(OrientationBlock, PassiveNumbersTurnCrystalAxesIntoSampleAxes) {
  const core::Vec3 r(0.1, -0.2, 0.3);
  EXPECT_LT(distance(read("rodrigues:passive 0.1 -0.2 0.3"), core::from_rodrigues(r)), 1e-15);
  EXPECT_LT(distance(read("rodrigues:active 0.1 -0.2 0.3"), core::from_rodrigues(-r)), 1e-15);
  // [100] of the crystal lies along y.
  const core::Quaternion q = read("euler-bunge:passive 90 0 0");
  EXPECT_LT((q * core::Vec3::UnitX() - core::Vec3::UnitY()).norm(), 1e-15);
}

TEST(OrientationBlock, WhatIsWrittenComesBackBitForBit) {
  core::Random random(1, core::Stream::tests);
  const TemporaryFile file("ori.txt", "");
  for (int i = 0; i < 50; ++i) {
    const core::Quaternion q = random.rotation();
    core::FileWriter out(file.path());
    out.put(written_descriptor);
    put_orientation(out, q);
    out.finish();
    const core::Quaternion back = read(core::read_text(file.path()));
    EXPECT_LE((back.coeffs() - q.coeffs()).cwiseAbs().maxCoeff(), 1e-16);
    EXPECT_LT(std::abs(q.norm() - 1), 1e-15);
  }
}

TEST(OrientationBlock, SaysWhatIsWrong) {
  EXPECT_EQ(fault("euler-bunge:backwards 1 2 3"),
            "ori:1: orientations are 'euler-bunge:backwards'; read are rodrigues, quaternion, "
            "axis-angle, euler-bunge, euler-kocks, euler-roe, rotmat, each with :active or "
            ":passive");
  EXPECT_NE(fault("homochoric 1 2 3"), "");
  EXPECT_EQ(fault("quaternion\n1 1 0 0"), "ori:2: a quaternion of length 1.41421, not 1");
  EXPECT_EQ(fault("axis-angle 0 0 0 1"), "ori:1: an axis of rotation without a direction");
  EXPECT_EQ(fault("rotmat 1 0 0 0 1 0 0 0 -1"), "ori:1: a matrix that is no rotation");
  EXPECT_EQ(fault("rodrigues 1 2"),
            "ori:1: the file ends where a number of an orientation should be");
}

}  // namespace
}  // namespace polyslip::mesh

#include "results/macro_csv.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.hpp"
#include "fabricated.hpp"

namespace polyslip {
namespace {

using results::MacroCsv;

results::MacroRow row(double strain) {
  results::MacroRow r;
  r.strain = strain;
  r.time = 1.0 / 3;
  r.step_size = 1e-300;
  r.stress = {0.1, -0.0, -31.25, 1, 2, 3};
  r.fx_x1 = 4;
  r.fy_y1 = 5;
  r.fz_z1 = -6.5;
  r.newton_iterations = 7;
  r.linear_iterations = 80;
  r.remeshed = true;
  r.load_strain = -0.5;
  r.load_stress = 30;
  for (std::size_t face = 0; face < 6; ++face)
    for (std::size_t i = 0; i < 3; ++i)
      r.face_forces[face][i] = 10.0 * static_cast<double>(face + 1) + static_cast<double>(i + 1);
  return r;
}

TEST(MacroCsv, HeaderAndNumbersAsPromised) {
  const tests::TemporaryFolder folder;
  auto csv = MacroCsv::create(folder / "macro.csv");
  csv.append(row(0.02));
  EXPECT_EQ(tests::slurp(folder / "macro.csv"),
            "strain,time,step_size,sxx,syy,szz,syz,szx,sxy,fx_x1,fy_y1,fz_z1,newton_iterations,"
            "linear_iterations,remeshed,load_strain,load_stress,fx_x0,fy_x0,fz_x0,fy_x1,fz_x1,fx_"
            "y0,fy_y0,"
            "fz_y0,fx_y1,fz_y1,fx_z0,fy_z0,fz_z0,fx_z1,fy_z1\n"
            "0.02,0.3333333333333333,1e-300,0.1,-0,-31.25,1,2,3,4,5,-6.5,7,80,1,-0.5,30,11,12,13,"
            "22,23,31,32,33,41,43,51,52,53,"
            "61,62\n");
  EXPECT_EQ(std::strtod("0.3333333333333333", nullptr), 1.0 / 3);
}

TEST(MacroCsv, ResumesAfterWholeRowsOnly) {
  const tests::TemporaryFolder folder;
  const std::string path = folder / "macro.csv";
  {
    auto csv = MacroCsv::create(path);
    for (int i = 0; i < 5; ++i) csv.append(row(i));
    csv.sync();
  }
  const std::string five = tests::slurp(path);
  tests::spit(path, five + "5,0.33");
  {
    auto csv = MacroCsv::resume(path, 5);
    EXPECT_EQ(tests::slurp(path), five);
    csv.append(row(5));
    EXPECT_EQ(csv.rows(), 6);
  }
  EXPECT_EQ(tests::slurp(path), five + results::macro_line(row(5)));
  MacroCsv::resume(path, 2).append(row(2));
  EXPECT_EQ(tests::slurp(path), results::macro_header + "\n" + results::macro_line(row(0)) +
                                    results::macro_line(row(1)) + results::macro_line(row(2)));
}

TEST(MacroCsv, RefusesWhatItCannotGoOnWith) {
  const tests::TemporaryFolder folder;
  EXPECT_THROW(MacroCsv::resume(folder / "none.csv", 0), core::InputError);
  EXPECT_THROW(MacroCsv::create(folder / "none/macro.csv"), core::InputError);
  MacroCsv::create(folder / "macro.csv").append(row(0));
  const std::string before = tests::slurp(folder / "macro.csv");
  EXPECT_THROW(MacroCsv::resume(folder / "macro.csv", 2), core::InputError);
  EXPECT_EQ(tests::slurp(folder / "macro.csv"), before);
  tests::spit(folder / "macro.csv", "a,b\n1,2\n");
  EXPECT_THROW(MacroCsv::resume(folder / "macro.csv", 0), core::InputError);
}

}  // namespace
}  // namespace polyslip

#pragma once
// macro.csv: the macroscopic curve, one row a step.

#include <array>
#include <cstdio>
#include <memory>
#include <string>

namespace polyslip::results {

inline const std::string macro_header =
    "strain,time,step_size,sxx,syy,szz,syz,szx,sxy,fx_x1,fy_y1,fz_z1,newton_iterations,"
    "linear_iterations,remeshed,load_strain,load_stress,fx_x0,fy_x0,fz_x0,fy_x1,fz_x1,fx_y0,fy_y0,"
    "fz_y0,fx_y1,fz_y1,fx_z0,fy_z0,fz_z0,fx_z1,fy_z1";

/// One accepted step.
struct MacroRow {
  double strain = 0, time = 0, step_size = 0;  ///< path of the load and time at the end; 1, s, 1
  std::array<double, 6> stress{};              ///< xx yy zz yz zx xy, volume average, MPa
  double fx_x1 = 0, fy_y1 = 0, fz_z1 = 0;      ///< force of the surroundings on the body
  int newton_iterations = 0, linear_iterations = 0;
  bool remeshed = false;                    ///< the first step after a remeshing
  double load_strain = 0, load_stress = 0;  ///< signed strain of the load, its stress; 1, MPa
  std::array<std::array<double, 3>, 6> face_forces{};  ///< as fx_x1, of all faces x0 ... z1
};

/// Numbers in the shortest form that reads back to the same double.
std::string macro_line(const MacroRow& row);

/// Appends rows; each is handed to the system before `append` returns.
class MacroCsv {
 public:
  /// Starts a new file (replacing an old one) with the header. InputError if that is impossible.
  static MacroCsv create(const std::string& path);
  /// Goes on after the first `rows` rows: later ones, and the torn line of a kill, are cut off.
  /// InputError if the file has fewer whole rows or another header; it is then left as it was.
  static MacroCsv resume(const std::string& path, long rows);

  void append(const MacroRow& row);
  /// Rows in the file.
  long rows() const { return rows_; }
  /// Makes the rows durable; before a checkpoint that counts on them.
  void sync();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  MacroCsv(std::string path, long rows);
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
  long rows_ = 0;
};

}  // namespace polyslip::results

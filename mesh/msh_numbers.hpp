#pragma once
// Numbers of Gmsh's files, which are words in an ASCII file and bytes in a binary one.

#include <cstdint>

#include "mesh/text_scanner.hpp"

namespace polyslip::mesh {

class MshNumbers {
 public:
  explicit MshNumbers(TextScanner& in) : in_(in) {}

  /// Numbers are bytes from now on: the rest of the line and the 1 that tells the byte order.
  void begin_binary();
  bool binary() const { return binary_; }
  /// Ends the line of a heading: bytes follow. Nothing in an ASCII file.
  void end_line();

  int integer(const char* what);
  /// Format 4.1's counts and tags, eight bytes long; InputError beyond an int.
  int wide(const char* what);
  /// A count of things of at least `bytes` bytes each, which the rest of the file can hold.
  int wide_count(const char* what, std::size_t bytes);
  double number(const char* what);

 private:
  template <class T>
  T take(const char* what);

  TextScanner& in_;
  bool binary_ = false, swapped_ = false;
};

}  // namespace polyslip::mesh

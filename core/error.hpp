#pragma once
// The three kinds of failure and who mends them (docs/design: errors).

#include <stdexcept>
#include <string>

namespace polyslip::core {

/// The user can mend it: a wrong deck, a missing file, a folder that is not writable. `what()` is
/// one line that names the place, the value and the remedy. The program ends with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// We have to mend it: an invariant that does not hold. `what()` gives the place and the values.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// The time stepper mends it by a smaller step, or a fallback takes over.
class RecoverableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace polyslip::core

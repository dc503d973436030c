#pragma once
// Owning handles of PETSc objects and the check of PETSc's returns. A handle wraps to own, not to
// rename: `.get()` is the PETSc object.

#include <petscksp.h>

#include <source_location>
#include <utility>

namespace polyslip::solver {

namespace detail {
[[noreturn]] void throw_petsc_error(PetscErrorCode code, const std::source_location& where);
}

/// Throws core::InternalError, with PETSc's message and the place of the call, if `code` is not 0.
inline void check(PetscErrorCode code,
                  const std::source_location& where = std::source_location::current()) {
  if (code != 0) detail::throw_petsc_error(code, where);
}

/// Owns one reference to a PETSc object; empty or not. No copy; a move exchanges.
/// Destruction is collective where the object's is.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class PetscHandle {
 public:
  PetscHandle() = default;
  ~PetscHandle() { reset(); }
  PetscHandle(const PetscHandle&) = delete;
  PetscHandle& operator=(const PetscHandle&) = delete;
  PetscHandle(PetscHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscHandle& operator=(PetscHandle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }

  /// Takes over the caller's reference.
  static PetscHandle adopt(Object object) {
    PetscHandle handle;
    handle.object_ = object;
    return handle;
  }
  /// Adds a reference to an object that someone else owns too.
  static PetscHandle share(Object object) {
    if (object) check(PetscObjectReference(reinterpret_cast<PetscObject>(object)));
    return adopt(object);
  }

  Object get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }
  /// Drops what is held and returns where a PETSc `...Create(..., Object*)` may put a new object.
  Object* out() {
    reset();
    return &object_;
  }
  /// The held object as an argument that PETSc may replace or reuse (MatPtAP's, for instance).
  Object* in_out() { return &object_; }
  Object release() { return std::exchange(object_, nullptr); }
  void reset() noexcept {
    if (object_) static_cast<void>(Destroy(&object_));
    object_ = nullptr;
  }

 private:
  Object object_ = nullptr;
};

using MatHandle = PetscHandle<Mat, MatDestroy>;
using VecHandle = PetscHandle<Vec, VecDestroy>;
using KspHandle = PetscHandle<KSP, KSPDestroy>;
using PcHandle = PetscHandle<PC, PCDestroy>;
using IsHandle = PetscHandle<IS, ISDestroy>;
using ScatterHandle = PetscHandle<VecScatter, VecScatterDestroy>;
using RandomHandle = PetscHandle<PetscRandom, PetscRandomDestroy>;
using NullSpaceHandle = PetscHandle<MatNullSpace, MatNullSpaceDestroy>;
using ViewerHandle = PetscHandle<PetscViewer, PetscViewerDestroy>;
using PartitioningHandle = PetscHandle<MatPartitioning, MatPartitioningDestroy>;

}  // namespace polyslip::solver

#pragma once

#include <memory>
#include <mutex>

#include "palpate/field/analytic.hpp"
#include "palpate/scene/scene_field.hpp"
#include "scene.hpp"

namespace palpate::python {

/// A field that Python holds. One thread uses it at a time: who holds the mutex.
class AnyField {
 public:
  virtual ~AnyField() = default;
  AnyField(const AnyField&) = delete;
  AnyField& operator=(const AnyField&) = delete;

  [[nodiscard]] virtual const Field& field() const noexcept = 0;
  /// A proxy made a step in it at `now`, s: what stamps are compared with.
  virtual void stepped(double /*now*/) noexcept {}
  /// Null: it is a formula.
  [[nodiscard]] virtual SceneField* of_scene() noexcept { return nullptr; }

  std::mutex mutex;

 protected:
  AnyField() = default;
};

}  // namespace palpate::python

// What a tool's proxy keeps from step to step.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "palpate/tool/tool_proxy.hpp"
#include "tool/descent.hpp"
#include "tool/tool_spring.hpp"

namespace palpate {

/// What a tool's proxy does and what it keeps from step to step. Real-time.
class ToolProxy::Inside {
 public:
  /// The options are complete.
  Inside(std::shared_ptr<const Tool> tool, const ToolOptions& options)
      : tool_(std::move(tool)),
        options_(options),
        descent_(tool_, {options_.gyration}, options_.iterations) {}

  [[nodiscard]] ToolContact step(const ToolSurface& surface, const Pose& given, double dt) noexcept;
  void reset(const Pose& given) noexcept;
  void change(double stiffness, const Friction& friction, const Texture& texture) noexcept {
    options_.stiffness = stiffness;
    options_.friction = friction;
    options_.texture = texture;
  }

  [[nodiscard]] bool has_begun() const noexcept {
    return state_ == State::put || state_ == State::begun;
  }
  [[nodiscard]] const Pose& pose() const noexcept { return descent_.pose(); }
  [[nodiscard]] const Tool& tool() const noexcept { return *tool_; }
  [[nodiscard]] const ToolOptions& options() const noexcept { return options_; }

 private:
  enum class State {
    none,   // it is nowhere yet
    put,    // it was put where it may be inside of something
    begun,  // it has been outside since
    fault,  // an input was not finite
  };
  struct Factors {
    double stiffness = 1;
    double friction = 1;
  };

  [[nodiscard]] ToolContact faulted() const noexcept;
  [[nodiscard]] bool path_is_free(const Field& field, const Pose& hand) noexcept;
  void see(const ToolSurface& surface, const Field::Traits& traits) noexcept;
  bool move(const ToolSurface& surface, const Pose& hand, const FrictionLaw& law,
            ToolContact& contact) noexcept;
  void begin(const ToolSurface& surface, const Pose& hand, bool outside,
             ToolContact& contact) noexcept;
  void free_hand(const Field& field, const Pose& hand, bool outside, double dt,
                 ToolContact& contact) noexcept;
  void end(const ToolSurface& surface) noexcept;
  void end_group(const ToolSurface& surface, int group) noexcept;
  void pull(const Pose& before, const Pose& hand, double dt, const double* step,
            ToolContact& contact) noexcept;
  void report(const ToolSurface& surface, ToolContact& contact) noexcept;

  std::shared_ptr<const Tool> tool_;
  ToolOptions options_;
  Descent descent_;
  ToolSpring spring_;
  Pose hand_;                              // in the last step that caught up with it
  Pose last_hand_;                         // in the last step
  const Field* field_ = nullptr;           // in the last step; never looked into
  std::optional<std::uint64_t> revision_;  // of it, then; empty: no step since a reset
  Factors factors_;                        // by what was touched last
  bool changed_ = false;                   // is the surface another than in the last step?
  State state_ = State::none;
};

}  // namespace palpate

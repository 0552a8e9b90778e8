// What a field of a tool follows of the scene, and the groups that it divides the tool into.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "palpate/tool/tool_field.hpp"
#include "tool/sample_group.hpp"

namespace palpate {

/// What a field of a tool follows and has gathered. Real-time but for construction.
class ToolField::Inside final : public Field {
 public:
  Inside(Scene& scene, std::shared_ptr<const Tool> tool, const FieldOptions& options,
         const std::string& name, double scale);

  void update(double now, const Pose& hand, const Pose& proxy) noexcept;
  void take(const FieldOptions& checked) noexcept;
  void forget_sides() noexcept;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override;
  [[nodiscard]] Surface surface(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] Traits traits() const noexcept override;
  void begin_step() const noexcept override;

  [[nodiscard]] int group_of(int sample) const noexcept {
    return group_of_[static_cast<std::size_t>(sample)];
  }
  [[nodiscard]] const Field& group(int number) const noexcept {
    return groups_[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] double moved() const noexcept { return moved_; }
  [[nodiscard]] std::size_t samples() const noexcept { return group_of_.size(); }
  [[nodiscard]] FieldNote notes() const noexcept;
  /// The groups that serve samples.
  [[nodiscard]] std::span<SampleGroup> used() noexcept {
    return std::span(groups_).first(static_cast<std::size_t>(count_));
  }
  [[nodiscard]] TouchedScene& scene() const noexcept { return scene_; }

 private:
  void change(double moved) noexcept;
  void divide_anew() noexcept;
  void divide(double radius) noexcept;
  void assign(std::int32_t root, double radius) noexcept;

  std::shared_ptr<const Tool> tool_;
  mutable TouchedScene scene_;
  std::vector<SampleGroup> groups_;
  std::array<AgreedSides, 3> fingers_;  // of samples with sides -1, 0 and 1
  std::vector<std::uint8_t> group_of_;  // of samples
  int count_ = 0;                       // of groups that serve samples
  double radius_ = 0;                   // R that the groups were made for, m
  FieldNote notes_ = FieldNote::none;   // of the last update
  std::uint64_t revision_ = 0;
  double now_ = 0;                                                  // of the last update, s
  double widened_ = 0;                                              // TouchedScene::widened() then
  mutable double moved_ = std::numeric_limits<double>::infinity();  // by the surface since the last
                                                                    // step began, at most, m
};

}  // namespace palpate

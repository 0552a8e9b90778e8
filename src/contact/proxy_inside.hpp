#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "contact/energy_tank.hpp"
#include "contact/probe.hpp"
#include "contact/slide.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate {

/// What a proxy does and what it keeps from step to step. Real-time.
class Proxy::Inside {
 public:
  /// Checked options.
  explicit Inside(const ProxyOptions& options) : options_(options) {}

  [[nodiscard]] Contact step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept;
  void reset(const Eigen::Vector3d& position) noexcept;

  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }
  [[nodiscard]] const ProxyOptions& options() const noexcept { return options_; }
  void change(const ProxyOptions& checked) noexcept { options_ = checked; }

 private:
  void follow(Probe& probe, const Eigen::Vector3d& hip, Contact& contact) noexcept;
  void touch(Probe& probe, const Eigen::Vector3d& place, const Eigen::Vector3d& hip) noexcept;
  void release(const Eigen::Vector3d& place) noexcept;
  void hold(Probe& probe, const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;
  [[nodiscard]] std::optional<SurfacePoint> find_surface(Probe& probe, const Eigen::Vector3d& hip,
                                                         Contact& contact) noexcept;
  [[nodiscard]] bool settle(const Slide& motion, Contact& contact) noexcept;
  void pull(const Eigen::Vector3d& hip, double dissipated, double dt, Contact& contact) noexcept;
  void keep(Probe& probe, const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;
  void cut_short(Contact& contact) noexcept;
  void let_go(Probe& probe, const Eigen::Vector3d& hip) noexcept;
  [[nodiscard]] double wanted_stiffness() const noexcept;
  [[nodiscard]] double begun_stiffness(const Eigen::Vector3d& place,
                                       const Eigen::Vector3d& hip) const noexcept;
  [[nodiscard]] double unexplained(const Eigen::Vector3d& before, const Eigen::Vector3d& hip,
                                   double dt) const noexcept;
  void take_over(const EnergyTank& before, const Eigen::Vector3d& hip, Contact& contact) noexcept;
  [[nodiscard]] Contact faulted() noexcept;

  ProxyOptions options_;
  EnergyTank tank_;
  FadingSpring fading_;  // of contacts that a change of the surface ended
  Surface surface_;      // where the proxy touches
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  // of the last contact; zero: none
  Eigen::Vector3d hand_ = Eigen::Vector3d::Zero();    // that the proxy last caught up with
  double step_length_ = 0;                            // R where it was last known, m
  double lost_time_ = 0;                              // s since the surface was lost
  std::optional<std::uint64_t> revision_;             // of the field in the last step
  bool started_ = false;
  bool touching_ = false;
  bool sliding_ = false;
  bool cut_short_ = false;  // the last step's search, by its budget
  bool fault_ = false;
};

}  // namespace palpate

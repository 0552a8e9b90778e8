#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "contact/escape_search.hpp"
#include "contact/probe.hpp"
#include "contact/slide.hpp"
#include "contact/spring.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate {

/// What a proxy does and what it keeps from step to step. Real-time.
class Proxy::Inside {
 public:
  /// Checked options.
  explicit Inside(const ProxyOptions& options) : options_(options) {}

  [[nodiscard]] Contact step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept;
  void reset(const Eigen::Vector3d& position) noexcept;

  [[nodiscard]] bool has_begun() const noexcept { return started_ && !fault_; }
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }
  /// The caller checks what it changes.
  [[nodiscard]] ProxyOptions& options() noexcept { return options_; }

 private:
  static constexpr double kFaded = 0.01;  // of the stiffness: a spring that is gone

  /// The contact. It holds the hand unless it waits for a surface that vanished.
  struct Touch {
    Surface surface;                                   // at the proxy
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // as the last step left it; zero: none
    // The side that the contact came from: the normal where it began, as slides have turned it
    // since. A surface that turns by itself does not take it along.
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    Eigen::Vector3d pressed = Eigen::Vector3d::Zero();  // the hand when the surface vanished, m
    bool touching = false;
    bool sliding = false;
    bool waiting = false;  // for a surface that has vanished

    [[nodiscard]] bool is_held() const noexcept { return touching && !waiting; }
    // Turns the side as a slide from a position with this normal to here turned the normal.
    void carry_side(const Eigen::Vector3d& from) noexcept;
    // What the surface leaves of the stiffness. A hand that no motor moves feels it whole until the
    // surface is gone: a press of constant force would sink into what fades.
    [[nodiscard]] double softened(const ProxyOptions& options) const noexcept;
  };

  /// What the budget left of the last step's search.
  struct Search {
    bool is_cut_short = false;
    int looked = 0;  // positions that recover() has looked at

    // The next step has the whole budget for where this one stopped: it does not re-anchor first.
    void cut_short(Contact& contact) noexcept;
  };

  void follow(Probe& probe, const Eigen::Vector3d& hip, Contact& contact) noexcept;
  void touch(Probe& probe, const Eigen::Vector3d& position, const Eigen::Vector3d& hip) noexcept;
  void release(const Eigen::Vector3d& position, Standing standing = Standing::front) noexcept;
  void hold(Probe& probe, const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;
  [[nodiscard]] std::optional<SurfacePoint> find_surface(Probe& probe, const Eigen::Vector3d& hip,
                                                         Contact& contact) noexcept;
  [[nodiscard]] bool settle(const Slide& motion, Contact& contact) noexcept;
  void keep(Probe& probe, const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;
  void await(Probe& probe, const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
             const Eigen::Vector3d& pressed, const Eigen::Vector3d& hip) noexcept;
  void let_go(Probe& probe, const Eigen::Vector3d& hip) noexcept;
  void free_hand(Probe& probe, const Eigen::Vector3d& before, const Eigen::Vector3d& hip, double dt,
                 Contact& contact, bool changed) noexcept;
  void pull(const Eigen::Vector3d& hip, double dissipated, double dt, Contact& contact) noexcept;
  [[nodiscard]] double initial_stiffness(const Eigen::Vector3d& position,
                                         const Eigen::Vector3d& hip) const noexcept;
  [[nodiscard]] double unexplained_jump(const Eigen::Vector3d& before, const Eigen::Vector3d& hip,
                                        double dt) const noexcept;
  void take_over(const EnergyTank& before, const Eigen::Vector3d& hip, Contact& contact) noexcept;

  ProxyOptions options_;
  Spring spring_;
  EscapeSearch escape_;  // of a static scene
  Touch touch_;
  Eigen::Vector3d position_{0, 0, 0};
  Eigen::Vector3d hand_{0, 0, 0};  // that the proxy last caught up with
  double radius_ = 0;              // R where it was last sampled, m
  Search search_;
  std::optional<std::uint64_t> revision_;  // of the field in the last step
  Standing standing_ = Standing::front;    // of a free proxy
  bool started_ = false;
  bool fault_ = false;
};

}  // namespace palpate

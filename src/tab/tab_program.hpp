// Declares the program that runs in a tab of a browser.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "palpate/geometry/point_cloud.hpp"
#include "tab/tab_run.hpp"

namespace palpate::tab {

/// What is touched.
struct Touched {
  std::string name;  ///< for people
  PointCloud cloud;
};

/// A cloud that a formula makes, by its name: "synthetic:torus".
/// @throws Error that lists the names.
[[nodiscard]] Touched synthetic(const std::string& name);

/// The cloud in the bytes of a file of that name, by read_cloud_bytes(). @throws Error as it does.
[[nodiscard]] Touched of_file(std::span<const std::byte> bytes, const std::string& name);

/// A cloud, and one simulated hand that the page may take. Device, hand and servo are simulated
/// together, so what is felt does not depend on how often run() is called.
class TabProgram final : public TabRun {
 public:
  /// Prepares the cloud. @throws Error as preparing does, and where there is nothing to touch.
  TabProgram(Touched touched, Outside outside, const Clock& stopwatch, std::string news = {});
  ~TabProgram() override;

  void connect(double now) override;
  void receive(std::string_view text, double now) override;
  /// What is later than kMostLate is left out.
  int run(double now) override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::tab

// Declares the program that runs in a tab of a browser.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "tab/tab_run.hpp"
#include "tab/tab_source.hpp"

namespace palpate::tab {

/// A cloud or a camera, and one simulated hand that the page may take. Camera, device, hand and
/// servo are simulated together, so what is felt does not depend on how often run() is called.
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

// Declares the replay of a recording in a tab of a browser.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "bag/random_file.hpp"
#include "tab/tab_run.hpp"

namespace palpate::tab {

/// A recorded run with its time line, as `palpate replay --view` shows it: nothing is computed
/// again but the surface around the tools.
class TabReplay final : public TabRun {
 public:
  /// Shows the first moment that has a surface. @throws Error when the file is no recording of a
  /// run.
  TabReplay(bag::RandomFile file, Outside outside, const Clock& stopwatch,
            const std::string& news = {});
  ~TabReplay() override;

  void connect(double now) override;
  void receive(std::string_view text, double now) override;
  int run(double now) override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::tab

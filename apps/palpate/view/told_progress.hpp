// Shows pages how far reading and preparing are.
#pragma once

#include <cmath>
#include <string>

#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

/// Shows pages how far something is, once for each percent.
class PageProgress {
 public:
  /// `share`: as Viewer::progress() takes it.
  void show(Viewer& viewer, const std::string& what, double share) {
    // What is at its end is shown as 100 % only then.
    const double percent = std::floor(100 * share);
    if (percent == percent_ && (what == what_ || percent == 100)) return;
    percent_ = percent;
    what_ = what;
    viewer.progress(what, percent / 100);
  }

  /// The same of a cloud that is read up to `share`, and prepared from 1 on.
  void show_cloud(Viewer& viewer, const std::string& name, double share) {
    const bool reads = share < 1;
    show(viewer, (reads ? "reading " : "preparing ") + name, reads ? share : 0);
  }

 private:
  std::string what_;
  double percent_ = 100;
};

}  // namespace palpate::app

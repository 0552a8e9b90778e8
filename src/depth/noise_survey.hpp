#pragma once

#include <array>
#include <vector>

#include "depth/noise_level.hpp"
#include "palpate/depth/noise_model.hpp"

namespace palpate::depth {

/// What single frames say of the noise.
struct FrameNoise {
  std::vector<NoiseSample> samples;  ///< sigma by depth; none: too little could be used
  double shared = 1;                 ///< n_c
  bool whole = false;                ///< the windows held all of the correlation; else n_c is low
};

/// Looks at the residuals of windows all over the image, of three sizes: small ones see noise and
/// little shape; where neighbours err together small windows take noise for shape, and larger ones
/// are used. One round over the image can be spread over many frames.
class NoiseSurvey {
 public:
  NoiseSurvey();

  /// Lays windows over images of this size and begins anew. Takes memory when the size is new.
  void resize(int width, int height);

  /// Does a share of 1 / shares of a round. True when it completes the round: then the results
  /// below are up to date, and the next call begins another round.
  bool advance(const DepthView& frame, int shares);

  [[nodiscard]] const FrameNoise& noise() const { return noise_; }

  /// How much wide windows miss beyond what independent noise `model` explains: the lower quarter
  /// of sqrt(X_q / dof) at c = 1, at most kMostMisfit. 1 where no window could be used. Of the
  /// round that has just been completed.
  [[nodiscard]] double misfit(const NoiseModel& model);

  static constexpr double kMostMisfit = 6;

 private:
  bool measure_one(const DepthView& frame, double& budget);
  bool correlate_one(const DepthView& frame, double& budget);
  void conclude();

  std::array<NoiseLevel, 3> levels_;
  NoiseWindowFitter fitter_;
  std::size_t level_ = 0;  // at work on
  std::size_t next_ = 0;   // window of it
  bool correlating_ = false;
  FrameNoise noise_;
  std::vector<float> ratios_;
};

}  // namespace palpate::depth

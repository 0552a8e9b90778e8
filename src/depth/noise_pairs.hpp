#pragma once

#include <array>
#include <vector>

#include "depth/depth_view.hpp"
#include "depth/noise_bins.hpp"
#include "palpate/depth/noise_model.hpp"

namespace palpate::depth {

/// What differences of frames say of the noise.
struct PairNoise {
  std::vector<NoiseSample> samples;  ///< sigma by depth; none: nothing stood still
  double shared = 0;                 ///< n_c; 0: not known
};

/// Compares each frame with the one before in tiles of 16x16 pixels: where the scene stands still
/// the difference is noise, whatever the shape (nss_fast.md section 2). What the sensor does in the
/// same way in every frame is not seen. Each frame is looked at in one part of the image, part
/// after part; old frames are forgotten little by little.
class NoisePairs {
 public:
  NoisePairs();

  /// Takes memory when the size is new; forgets everything.
  void resize(int width, int height);

  /// Takes in the next frame. `noise` and `shared` are what single frames say: tiles that differ
  /// by more have moved. False when the frame repeats the one before: then it is not taken in.
  bool add(const DepthView& frame, const NoiseModel& noise, double shared);

  [[nodiscard]] const PairNoise& noise() const { return noise_; }

 private:
  /// The difference in one tile.
  struct Tile {
    float z = 0;       // 0: not to be used
    float mean = 0;    // m
    float within = 0;  // variance around the mean, m^2
  };

  /// Running sums of one depth.
  struct Bin {
    double tiles = 0;
    double z = 0;
    double within = 0;
    double mean2 = 0;        // squares of the tiles' means
    double large_tiles = 0;  // of 2x2 tiles
    double large_mean2 = 0;
    double large_power = 0;  // squares of the differences in them
  };

  [[nodiscard]] bool in_part(int row) const;
  void keep(const DepthView& frame);
  bool compare(const DepthView& frame);
  void drop_moving(const NoiseModel& noise, double shared);
  void accumulate(int bin);
  void accumulate_large();
  void conclude(double shared);

  int width_ = 0;
  int height_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  bool primed_ = false;
  int part_ = 0;
  std::vector<float> before_;
  std::vector<Tile> tiles_;
  std::vector<Tile> sorted_;  // those of one bin
  std::array<Bin, kNoiseBins> bins_{};
  PairNoise noise_;
};

}  // namespace palpate::depth

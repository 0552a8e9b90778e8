// Decodes LAZ chunks of point formats 0 - 3: all of a point comes from one range coder.
#include <cstdlib>
#include <vector>

#include "io/laz/color_model.hpp"
#include "io/laz/points.hpp"
#include "io/laz/xyz_model.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io::laz {
namespace {

// The format's classes of a return's number (column) among the returns of its pulse (row).
constexpr std::array<std::array<std::uint8_t, 8>, 8> kReturnClass8{
    {{15, 14, 13, 12, 11, 10, 9, 8},
     {14, 0, 1, 3, 6, 10, 10, 9},
     {13, 1, 2, 4, 7, 11, 11, 10},
     {12, 3, 4, 5, 8, 12, 12, 11},
     {11, 6, 7, 8, 9, 13, 13, 12},
     {10, 10, 11, 12, 13, 14, 14, 13},
     {9, 10, 11, 12, 13, 14, 15, 14},
     {8, 9, 10, 11, 12, 13, 14, 15}}};

// Passes over GPS times. There are four interleaved sequences of them, and each codes its next time
// by one model until it has a step that is not 0, and by another from then on. How long that step
// is, and the times, are of no use here.
class TimeModel {
 public:
  void skip(RangeDecoder& in) {
    // Switching to another sequence is followed by a step of it; more switches than sequences
    // are damage.
    for (std::size_t i = 0; i < has_step_.size(); ++i) {
      const std::uint32_t to = has_step_[now_] ? skip_multiple(in) : skip_first(in);
      if (to == 0) return;
      now_ = (now_ + to) % has_step_.size();
    }
  }

 private:
  static constexpr std::uint32_t kNothing = 511;  // no step
  static constexpr std::uint32_t kNew = 512;      // a new sequence

  // These return how many sequences further the time belongs; 0: it is passed.
  std::uint32_t skip_first(RangeDecoder& in) {
    const std::uint32_t symbol = in.symbol(first_);
    if (symbol == 1) {
      has_step_[now_] = number_.decode(in, 0, 0) != 0;
    } else if (symbol == 2) {
      begin_sequence(in);
    }
    return symbol > 2 ? symbol - 2 : 0;
  }

  std::uint32_t skip_multiple(RangeDecoder& in) {
    const std::uint32_t symbol = in.symbol(factor_);
    if (symbol < kNothing) {
      (void)number_.decode(in, 0, context(symbol));
    } else if (symbol == kNew) {
      begin_sequence(in);
    }
    return symbol > kNew ? symbol - kNew : 0;
  }

  // Up to 500 a symbol is a factor of the last step; above, 500 less the symbol is.
  static std::size_t context(std::uint32_t symbol) {
    if (symbol == 0) return 7;
    if (symbol == 1) return 1;
    if (symbol < 10) return 2;
    if (symbol < 500) return 3;
    return symbol == 500 ? 4 : symbol < 510 ? 5 : 6;
  }

  void begin_sequence(RangeDecoder& in) {
    begun_ = (begun_ + 1) % has_step_.size();
    (void)number_.decode(in, 0, 8);
    (void)in.raw(32);
    now_ = begun_;
    has_step_[now_] = false;
  }

  SymbolModel first_{6};
  SymbolModel factor_{516};
  NumberModel number_{32, 9};
  std::array<bool, 4> has_step_{};
  std::size_t now_ = 0;
  std::size_t begun_ = 0;
};

// Decodes the part of a point before its coordinates: flags, intensity, class, angle, user's byte
// and source.
class HeadModel {
 public:
  explicit HeadModel(const std::byte* record)
      : flags_(std::to_integer<std::uint8_t>(record[14])),
        class_(std::to_integer<std::uint8_t>(record[15])),
        user_(std::to_integer<std::uint8_t>(record[17])) {}

  // After decode(): the returns of the pulse, and this one's number.
  [[nodiscard]] int returns() const { return flags_ >> 3 & 7; }
  [[nodiscard]] int number() const { return flags_ & 7; }
  [[nodiscard]] std::size_t return_class() const {
    return kReturnClass8[static_cast<std::size_t>(returns())][static_cast<std::size_t>(number())];
  }
  [[nodiscard]] std::uint16_t intensity() const { return intensity_; }
  [[nodiscard]] std::uint8_t classification() const { return class_; }

  void decode(RangeDecoder& in) {
    const std::uint32_t changed = in.symbol(changed_);
    if (changed == 0) return;
    if ((changed & 32U) != 0) flags_ = byte(in, flag_models_[flags_]);
    const std::size_t m = return_class();
    if ((changed & 16U) != 0) {
      intensities_[m] = static_cast<std::uint16_t>(
          intensity_model_.decode(in, intensities_[m], std::min<std::size_t>(m, 3)));
    }
    intensity_ = intensities_[m];
    if ((changed & 8U) != 0) class_ = byte(in, class_models_[class_]);
    if ((changed & 4U) != 0) (void)in.symbol(angle_models_[flags_ >> 6U & 1U]);
    if ((changed & 2U) != 0) user_ = byte(in, user_models_[user_]);
    if ((changed & 1U) != 0) (void)source_model_.decode(in, 0);
  }

 private:
  static std::uint8_t byte(RangeDecoder& in, SymbolModel& model) {
    return static_cast<std::uint8_t>(in.symbol(model));
  }

  std::uint8_t flags_;
  std::uint8_t class_;
  std::uint8_t user_;
  std::uint16_t intensity_ = 0;  // the raw record's is not a prediction
  std::array<std::uint16_t, 16> intensities_{};
  SymbolModel changed_{64};
  std::vector<SymbolModel> flag_models_ = std::vector(256, SymbolModel(256));
  std::vector<SymbolModel> class_models_ = std::vector(256, SymbolModel(256));
  std::vector<SymbolModel> user_models_ = std::vector(256, SymbolModel(256));
  std::array<SymbolModel, 2> angle_models_ = symbol_models<2>(256);
  NumberModel intensity_model_{16, 4};
  NumberModel source_model_{16, 1};
};

struct Models {
  explicit Models(const LasHeader& header, const std::byte* record)
      : head(record), extra(header.extra_bytes(), SymbolModel(256)) {}

  HeadModel head;
  XyzModel xyz;
  std::array<RunningMedian, 16> step_x;
  std::array<RunningMedian, 16> step_y;
  std::array<std::int32_t, 8> heights{};
  TimeModel time;
  ColorModel color;
  std::vector<SymbolModel> extra;
};

// Changes the last point to the next one.
void decode_point(RangeDecoder& in, const LasHeader& header, Models& models, LasPoint& point) {
  HeadModel& head = models.head;
  head.decode(in);
  const bool single = head.returns() == 1;
  const std::size_t m = head.return_class();
  models.xyz.decode_xy(in, single, models.step_x[m], models.step_y[m], point.number);
  std::int32_t& height =
      models.heights[static_cast<std::size_t>(std::abs(head.returns() - head.number()))];
  height = models.xyz.decode_z(in, single, height);
  point.number[2] = height;
  point.intensity = head.intensity();
  point.withheld = (std::byte{head.classification()} & header.withheld_mask()) != std::byte{0};
  if (header.format == 1 || header.format == 3) models.time.skip(in);
  if (header.color_offset()) point.color = models.color.decode(in, point.color);
  for (SymbolModel& model : models.extra) (void)in.symbol(model);
}

}  // namespace

std::size_t decode_points_10(const LasHeader& header, std::span<const std::byte> chunk,
                             std::span<LasPoint> points) {
  points[0] = las_point(header, chunk.data());
  RangeDecoder in(chunk.subspan(header.record_size));
  Models models(header, chunk.data());
  LasPoint point = points[0];
  for (std::size_t i = 1; i < points.size(); ++i) {
    decode_point(in, header, models, point);
    if (in.overran()) return i;
    points[i] = point;
  }
  return points.size();
}

}  // namespace palpate::io::laz

// Compresses chunks of point formats 0 - 3 for tests.
#include "io/laz_encoder_inside.hpp"

namespace palpate {
namespace {

constexpr std::string_view kClasses8 =
    "fedcba98"
    "e0136aa9"
    "d1247bba"
    "c3458ccb"
    "b6789ddc"
    "aabcdeed"
    "9abcdefe"
    "89abcdef";

class Encoder10 {
 public:
  Encoder10(int format, std::string_view record)
      : format_(format),
        last_(record),
        extra_(record.size() - base(), SymbolModel(256)),
        time_(false, format == 1 || format == 3 ? load<std::int64_t>(record, 20) : 0) {}

  void encode(std::string_view record) {
    const auto flags = load<std::uint8_t>(record, 14);
    const int r = flags & 7;
    const int n = flags >> 3 & 7;
    const std::size_t m = hex_digit(kClasses8[static_cast<std::size_t>(8 * n + r)]);
    encode_head(record, m);
    xyz_.encode_xy(out_, n == 1, step_x_[m], step_y_[m], last_, record);
    xyz_.encode_z(out_, n == 1, heights_[static_cast<std::size_t>(std::abs(n - r))],
                  load<int>(record, 8));
    if (format_ == 1 || format_ == 3) time_.encode(out_, load<std::int64_t>(record, 20));
    if (format_ >= 2) {
      const std::size_t at = base() - 6;
      color_.encode(out_, std::string_view(last_).substr(at, 6), record.substr(at, 6));
    }
    for (std::size_t k = 0; k < extra_.size(); ++k) step(extra_[k], record, base() + k);
    last_ = record;
  }

  std::string finish() { return out_.finish(); }

 private:
  [[nodiscard]] std::size_t base() const { return std::array{20, 28, 26, 34}[format_]; }

  void step(SymbolModel& model, std::string_view record, std::size_t k) {
    out_.symbol(model, static_cast<std::uint8_t>(record[k] - last_[k]));
  }

  void set(std::vector<SymbolModel>& models, std::string_view record, std::size_t k) {
    out_.symbol(models[load<std::uint8_t>(last_, k)], load<std::uint8_t>(record, k));
  }

  void encode_head(std::string_view record, std::size_t m) {
    const auto changes = [&](std::size_t k) { return record[k] != last_[k] ? 1U : 0U; };
    const auto intensity = load<std::uint16_t>(record, 12);
    const std::uint32_t source = changes(18) | changes(19);
    const std::uint32_t changed = changes(14) << 5 | (intensity != intensities_[m] ? 1U : 0U) << 4 |
                                  changes(15) << 3 | changes(16) << 2 | changes(17) << 1 | source;
    out_.symbol(changed_, changed);
    if (changes(14) != 0) set(flags_, record, 14);
    if ((changed & 16U) != 0) {
      intensity_.encode(out_, intensities_[m], intensity, std::min<std::size_t>(m, 3));
      intensities_[m] = intensity;
    }
    if (changes(15) != 0) set(classes_, record, 15);
    if (changes(16) != 0) step(angles_[load<std::uint8_t>(record, 14) >> 6 & 1], record, 16);
    if (changes(17) != 0) set(users_, record, 17);
    if (source != 0) {
      source_.encode(out_, load<std::uint16_t>(last_, 18), load<std::uint16_t>(record, 18));
    }
  }

  int format_;
  std::string last_;
  RangeEncoder out_;
  SymbolModel changed_{64};
  std::vector<SymbolModel> flags_ = std::vector(256, SymbolModel(256));
  std::vector<SymbolModel> classes_ = std::vector(256, SymbolModel(256));
  std::vector<SymbolModel> users_ = std::vector(256, SymbolModel(256));
  std::array<SymbolModel, 2> angles_ = symbol_models<2>(256);
  NumberEncoder intensity_{16, 4};
  NumberEncoder source_{16, 1};
  std::array<std::uint16_t, 16> intensities_{};
  std::array<RunningMedian, 16> step_x_;
  std::array<RunningMedian, 16> step_y_;
  std::array<std::int32_t, 8> heights_{};
  XyzEncoder xyz_;
  ColorEncoder color_;
  std::vector<SymbolModel> extra_;
  TimeEncoder time_;
};

}  // namespace

std::string encode_chunk_10(int format, std::span<const std::string_view> records) {
  Encoder10 encoder(format, records[0]);
  for (const std::string_view record : records.subspan(1)) encoder.encode(record);
  return std::string(records[0]) + encoder.finish();
}

}  // namespace palpate

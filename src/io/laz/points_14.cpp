// Decodes LAZ chunks of point formats 6 - 8: layers of the chunk have range coders of their own,
// and each scanner channel has models of its own.
#include <cstdlib>
#include <optional>

#include "io/laz/color_model.hpp"
#include "io/laz/points.hpp"
#include "io/laz/xyz_model.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io::laz {
namespace {

// The format's classes of a return's number (column) among the returns of its pulse (row).
constexpr std::array<std::array<std::uint8_t, 16>, 16> kReturnClass16{{
    {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5},
    {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
    {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3},
    {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5},
}};

// The layers that are read; a layer of 0 bytes is absent, as its values never change in the chunk.
struct Layers {
  std::optional<RangeDecoder> xy;
  std::optional<RangeDecoder> z;
  std::optional<RangeDecoder> flags;
  std::optional<RangeDecoder> intensity;
  std::optional<RangeDecoder> color;

  [[nodiscard]] bool overran() const {
    const auto past_end = [](const auto& layer) { return layer && layer->overran(); };
    return past_end(xy) || past_end(z) || past_end(flags) || past_end(intensity) || past_end(color);
  }
};

// The last point of a scanner channel, which predicts the next one.
struct LastPoint {
  explicit LastPoint(const LasHeader& header, const std::byte* record)
      : point(las_point(header, record)),
        number(std::to_integer<int>(record[14]) & 15),
        returns(std::to_integer<int>(record[14]) >> 4) {
    const auto bits = std::to_integer<unsigned>(record[15]);
    flags = (bits & 15U) | (bits >> 6U & 3U) << 4U;
    begin();
  }

  // Predicts the first point of a channel from this point alone.
  void begin() {
    heights.fill(point.number[2]);
    intensities.fill(point.intensity);
    time_changed = false;
  }

  // First and last return of its pulse.
  [[nodiscard]] std::size_t first() const { return number == 1 ? 1 : 0; }
  [[nodiscard]] std::size_t last() const { return number >= returns ? 1 : 0; }

  LasPoint point;
  int number;
  int returns;
  unsigned flags;  // class flags in bits 0 - 3, direction, edge of the flight line
  bool time_changed = false;
  std::array<std::int32_t, 8> heights;  // by how far from the last return
  std::array<std::uint16_t, 8> intensities;
};

class Channel {
 public:
  explicit Channel(const LastPoint& before) : last_(before) { last_.begin(); }

  [[nodiscard]] const LastPoint& last() const { return last_; }

  // Which values change: the first symbol of each point, of the channel before.
  [[nodiscard]] std::uint32_t decode_changes(RangeDecoder& in) {
    return in.symbol(changes_[last_.first() + 2 * last_.last() + (last_.time_changed ? 4 : 0)]);
  }

  // 1 - 3: how much further the next point's channel is.
  [[nodiscard]] std::uint32_t decode_switch(RangeDecoder& in) { return in.symbol(switch_) + 1; }

  void decode_returns(RangeDecoder& in, std::uint32_t changes) {
    last_.time_changed = (changes & 16U) != 0;
    if ((changes & 4U) != 0) {
      last_.returns =
          static_cast<int>(in.symbol(returns_[static_cast<std::size_t>(last_.returns)]));
    }
    const auto before = static_cast<std::uint32_t>(last_.number);
    last_.number = static_cast<int>(number_after(in, changes & 3U, before) & 15U);
  }

  void decode_point(Layers& layers, const LasHeader& header) {
    const bool single = last_.returns == 1;
    const auto n = static_cast<std::size_t>(last_.returns);
    const auto r = static_cast<std::size_t>(last_.number);
    const std::size_t time = last_.time_changed ? 1 : 0;
    const std::size_t m = 2U * kReturnClass16[n][r] + time;
    LasPoint& point = last_.point;
    xyz_.decode_xy(*layers.xy, single, step_x_[m], step_y_[m], point.number);
    if (layers.z) {
      const int level = std::min(std::abs(last_.returns - last_.number), 7);
      std::int32_t& height = last_.heights[static_cast<std::size_t>(level)];
      height = xyz_.decode_z(*layers.z, single, height);
      point.number[2] = height;
    }
    if (layers.flags) {
      last_.flags = layers.flags->symbol(flags_[last_.flags]);
      point.withheld = (std::byte(last_.flags) & header.withheld_mask()) != std::byte{0};
    }
    if (layers.intensity) {
      const std::size_t context = last_.last() + 2 * last_.first();
      std::uint16_t& intensity = last_.intensities[2 * context + time];
      intensity =
          static_cast<std::uint16_t>(intensity_.decode(*layers.intensity, intensity, context));
      point.intensity = intensity;
    }
  }

 private:
  std::uint32_t number_after(RangeDecoder& in, std::uint32_t change, std::uint32_t number) {
    if (change == 0) return number;
    if (change == 1) return number + 1;
    if (change == 2) return number - 1;
    return last_.time_changed ? in.symbol(numbers_[number]) : number + 2 + in.symbol(jump_);
  }

  LastPoint last_;
  std::array<SymbolModel, 8> changes_ = symbol_models<8>(128);
  SymbolModel switch_{3};
  std::array<SymbolModel, 16> returns_ = symbol_models<16>(16);
  std::array<SymbolModel, 16> numbers_ = symbol_models<16>(16);
  SymbolModel jump_{13};
  XyzModel xyz_;
  std::array<RunningMedian, 12> step_x_;
  std::array<RunningMedian, 12> step_y_;
  std::array<SymbolModel, 64> flags_ = symbol_models<64>(64);
  NumberModel intensity_{16, 4};
};

// Colours have channels of their own, as LASzip 3 confuses them: it takes a point for one of
// channel 0 unless the channel changes with it, and predicts the first color after a change to a
// channel in use from the channel before.
class ColorChannels {
 public:
  ColorChannels(std::size_t channel, const Color& first) : now_(channel) {
    channels_[channel].emplace(first);
  }

  Color decode(RangeDecoder& in, std::size_t channel) {
    Color* last = &channels_[now_]->last;
    if (!channels_[channel]) {
      channels_[channel].emplace(*last);
      last = &channels_[channel]->last;
    }
    now_ = channel;
    *last = channels_[channel]->model.decode(in, *last);
    return *last;
  }

 private:
  struct OneChannel {
    explicit OneChannel(const Color& before) : last(before) {}
    Color last;
    ColorModel model;
  };

  std::size_t now_;
  std::array<std::optional<OneChannel>, 4> channels_;
};

class Decoder {
 public:
  Decoder(const LasHeader& header, const std::byte* record, Layers layers)
      : header_(header),
        layers_(layers),
        now_(std::to_integer<std::size_t>(record[15]) >> 4U & 3U),
        colors_(now_, las_point(header, record).color) {
    channels_[now_].emplace(LastPoint(header, record));
  }

  [[nodiscard]] bool overran() const { return layers_.overran(); }

  LasPoint next() {
    const std::size_t before = now_;
    const std::uint32_t changes = channels_[now_]->decode_changes(*layers_.xy);
    if ((changes & 64U) != 0) now_ = (now_ + channels_[now_]->decode_switch(*layers_.xy)) % 4;
    if (!channels_[now_]) channels_[now_].emplace(channels_[before]->last());
    Channel& channel = *channels_[now_];
    channel.decode_returns(*layers_.xy, changes);
    channel.decode_point(layers_, header_);
    LasPoint point = channel.last().point;
    if (layers_.color) point.color = colors_.decode(*layers_.color, now_ == before ? 0 : now_);
    return point;
  }

 private:
  const LasHeader& header_;
  Layers layers_;
  std::size_t now_;
  ColorChannels colors_;
  std::array<std::optional<Channel>, 4> channels_;
};

// Takes the layers behind the sizes that a chunk lists, in their order.
class LayerCutter {
 public:
  explicit LayerCutter(std::span<const std::byte> sizes_and_layers, std::size_t layers)
      : sizes_(sizes_and_layers.data()), rest_(sizes_and_layers.subspan(4 * layers)) {}

  // Nothing for a layer of 0 bytes. `fits` becomes false for one that the chunk does not hold.
  std::optional<RangeDecoder> take() {
    const std::size_t size = load_as<std::uint32_t>(sizes_);
    sizes_ += sizeof(std::uint32_t);
    fits_ = fits_ && size <= rest_.size();
    if (!fits_ || size == 0) return std::nullopt;
    const auto layer = rest_.first(size);
    rest_ = rest_.subspan(size);
    return RangeDecoder(layer);
  }

  [[nodiscard]] bool fits() const { return fits_; }

 private:
  const std::byte* sizes_;
  std::span<const std::byte> rest_;
  bool fits_ = true;
};

// Layers of format 6; formats 7 and 8 add one of colours.
constexpr std::size_t kPointLayers = 9;

// Nothing when the chunk is too short for its layers.
std::optional<Layers> cut_layers(const LasHeader& header, std::span<const std::byte> listed) {
  const std::size_t count = kPointLayers + (header.format >= 7 ? 1 : 0) +
                            (header.format == 8 ? 1 : 0) + header.extra_bytes();
  if (listed.size() < 4 * count) return std::nullopt;
  LayerCutter cutter(listed, count);
  Layers layers;
  layers.xy = cutter.take();
  layers.z = cutter.take();
  (void)cutter.take();  // classes
  layers.flags = cutter.take();
  layers.intensity = cutter.take();
  for (std::size_t i = 5; i < kPointLayers; ++i) (void)cutter.take();  // angle to time
  if (header.format >= 7) layers.color = cutter.take();
  if (!cutter.fits() || !layers.xy) return std::nullopt;
  return layers;
}

}  // namespace

std::size_t decode_points_14(const LasHeader& header, std::span<const std::byte> chunk,
                             std::span<LasPoint> points) {
  points[0] = las_point(header, chunk.data());
  if (points.size() == 1) return 1;
  const auto rest = chunk.subspan(header.record_size);
  constexpr std::size_t kCount = sizeof(std::uint32_t);
  if (rest.size() < kCount || load_as<std::uint32_t>(rest.data()) != points.size()) return 1;
  const std::optional<Layers> layers = cut_layers(header, rest.subspan(kCount));
  if (!layers) return 1;
  Decoder decoder(header, chunk.data(), *layers);
  for (std::size_t i = 1; i < points.size(); ++i) {
    points[i] = decoder.next();
    if (decoder.overran()) return i;
  }
  return points.size();
}

std::size_t decode_points(const LasHeader& header, std::span<const std::byte> chunk,
                          std::span<LasPoint> points) {
  if (points.empty()) return 0;  // a chunk behind the last point
  return header.extended() ? decode_points_14(header, chunk, points)
                           : decode_points_10(header, chunk, points);
}

}  // namespace palpate::io::laz

// Compresses chunks of point formats 6 - 8 for tests.
#include <memory>

#include "io/laz_encoder_inside.hpp"

namespace palpate {
namespace {

constexpr std::string_view kClasses16 =
    "0123453445555555"
    "1013333333333333"
    "2124444444433333"
    "3345444444444444"
    "4344544444444444"
    "5344454444444444"
    "3344445444444444"
    "4344444544444444"
    "4344444454444444"
    "5344444445444444"
    "5344444444544444"
    "5334444444455444"
    "5334444444455544"
    "5334444444445554"
    "5334444444444555"
    "5334444444444455";

// A layer is left out when none of its values changes.
struct Layer {
  RangeEncoder out;
  bool used = false;
};

struct Channel14 {
  explicit Channel14(std::string_view record)
      : last(record), time(true, load<std::int64_t>(record, 22)) {
    heights.fill(load<int>(record, 8));
    intensities.fill(load<std::uint16_t>(record, 12));
  }

  std::string last;
  bool time_changed = false;
  std::array<std::int32_t, 8> heights;
  std::array<std::uint16_t, 8> intensities;
  std::array<SymbolModel, 8> changes = symbol_models<8>(128);
  SymbolModel to_channel{3};
  std::array<SymbolModel, 16> returns = symbol_models<16>(16);
  std::array<SymbolModel, 16> numbers = symbol_models<16>(16);
  SymbolModel jump{13};
  XyzEncoder xyz;
  std::array<RunningMedian, 12> step_x;
  std::array<RunningMedian, 12> step_y;
  std::array<SymbolModel, 64> classes = symbol_models<64>(256);
  std::array<SymbolModel, 64> flags = symbol_models<64>(64);
  std::array<SymbolModel, 64> users = symbol_models<64>(256);
  NumberEncoder intensity{16, 4};
  NumberEncoder angle{16, 2};
  NumberEncoder source{16, 1};
  TimeEncoder time;
};

// The state of the bytes behind the 30 that all formats have.
struct Rest14 {
  explicit Rest14(std::string_view record) : last(record) {}

  std::string last;
  ColorEncoder color;
  std::array<SymbolModel, 2> infrared = symbol_models<2>(256);
  SymbolModel infrared_changed{4};
  std::vector<SymbolModel> extra = std::vector(64, SymbolModel(256));
};

std::uint32_t returns_of(std::string_view record) {
  return load<std::uint8_t>(record, 14) >> 4;
}
std::uint32_t number_of(std::string_view record) {
  return load<std::uint8_t>(record, 14) & 15;
}
std::size_t channel_of(std::string_view record) {
  return load<std::uint8_t>(record, 15) >> 4 & 3;
}
std::uint32_t flags_of(std::string_view record) {
  const auto bits = load<std::uint8_t>(record, 15);
  return (bits & 15U) | (bits >> 6U) << 4U;
}

class Encoder14 {
 public:
  Encoder14(int format, std::string_view record)
      : format_(format),
        base_(std::array<std::size_t, 3>{30, 36, 38}[format - 6]),
        layers_(9 + (format >= 7 ? 1 : 0) + (format == 8 ? 1 : 0) + record.size() - base_),
        now_(channel_of(record)) {
    channels_[now_] = std::make_unique<Channel14>(record);
    rest_now_ = now_;
    rests_[now_] = std::make_unique<Rest14>(record);
  }

  void encode(std::string_view record) {
    const std::size_t before = now_;
    encode_returns(record);
    encode_point(record);
    encode_rarer(record);
    encode_rest(record, now_ == before ? 0 : now_);
    channels_[now_]->last = record;
  }

  std::string finish(std::uint32_t points) {
    std::string sizes(reinterpret_cast<const char*>(&points), 4);
    std::string bytes;
    layers_[0].used = true;
    for (Layer& layer : layers_) {
      const std::string coded = layer.used ? layer.out.finish() : "";
      const auto size = static_cast<std::uint32_t>(coded.size());
      sizes.append(reinterpret_cast<const char*>(&size), 4);
      bytes += coded;
    }
    return sizes + bytes;
  }

 private:
  void encode_returns(std::string_view record) {
    RangeEncoder& out = layers_[0].out;
    Channel14& before = *channels_[now_];
    const std::size_t channel = channel_of(record);
    const bool begins = !channels_[channel];
    const std::string& last = begins ? before.last : channels_[channel]->last;
    const bool time = load<std::int64_t>(record, 22) != load<std::int64_t>(last, 22);
    const auto changes = [&](std::size_t k) { return record.substr(k, 2) != last.substr(k, 2); };
    const std::uint32_t jump = (number_of(record) - number_of(last)) & 15U;
    const std::uint32_t changed = (channel != now_ ? 64U : 0U) | (changes(20) ? 32U : 0U) |
                                  (time ? 16U : 0U) | (changes(18) ? 8U : 0U) |
                                  (returns_of(record) != returns_of(last) ? 4U : 0U) |
                                  (jump == 0    ? 0U
                                   : jump == 1  ? 1U
                                   : jump == 15 ? 2U
                                                : 3U);
    out.symbol(before.changes[(number_of(before.last) == 1 ? 1U : 0U) +
                              (number_of(before.last) >= returns_of(before.last) ? 2U : 0U) +
                              (before.time_changed ? 4U : 0U)],
               changed);
    if (channel != now_) {
      out.symbol(before.to_channel, static_cast<std::uint32_t>((channel - now_ - 1) % 4));
      if (begins) channels_[channel] = std::make_unique<Channel14>(before.last);
      now_ = channel;
    }
    Channel14& c = *channels_[now_];
    c.time_changed = time;
    if ((changed & 4U) != 0) out.symbol(c.returns[returns_of(c.last)], returns_of(record));
    if ((changed & 3U) == 3) {
      time ? out.symbol(c.numbers[number_of(c.last)], number_of(record))
           : out.symbol(c.jump, jump - 2);
    }
  }

  void put(std::size_t layer, SymbolModel& model, std::uint32_t now, std::uint32_t last) {
    layers_[layer].out.symbol(model, now);
    layers_[layer].used |= now != last;
  }

  void encode_point(std::string_view record) {
    Channel14& c = *channels_[now_];
    const std::uint32_t n = returns_of(record);
    const std::uint32_t r = number_of(record);
    const std::size_t time = c.time_changed ? 1 : 0;
    const std::size_t m = 2 * hex_digit(kClasses16[16 * n + r]) + time;
    const std::size_t context = (r >= n ? 1 : 0) + (r == 1 ? 2 : 0);
    c.xyz.encode_xy(layers_[0].out, n == 1, c.step_x[m], c.step_y[m], c.last, record);
    layers_[1].used |= load<int>(record, 8) != load<int>(c.last, 8);
    const int level = std::abs(static_cast<int>(n) - static_cast<int>(r));
    c.xyz.encode_z(layers_[1].out, n == 1, c.heights[static_cast<std::size_t>(std::min(level, 7))],
                   load<int>(record, 8));
    const auto last_class = load<std::uint8_t>(c.last, 16);
    put(2, c.classes[(last_class & 31U) << 1U | (context == 3 ? 1 : 0)],
        load<std::uint8_t>(record, 16), last_class);
    put(3, c.flags[flags_of(c.last)], flags_of(record), flags_of(c.last));
    const auto intensity = load<std::uint16_t>(record, 12);
    c.intensity.encode(layers_[4].out, c.intensities[2 * context + time], intensity, context);
    c.intensities[2 * context + time] = intensity;
    layers_[4].used |= intensity != load<std::uint16_t>(c.last, 12);
  }

  void encode_rarer(std::string_view record) {
    Channel14& c = *channels_[now_];
    const auto change = [&](std::size_t layer, NumberEncoder& model, std::size_t at,
                            std::size_t context) {
      const auto last = load<std::uint16_t>(c.last, at);
      const auto value = load<std::uint16_t>(record, at);
      if (value == last) return;
      layers_[layer].used = true;
      model.encode(layers_[layer].out, last, value, context);
    };
    change(5, c.angle, 18, c.time_changed ? 1 : 0);
    const auto last_user = load<std::uint8_t>(c.last, 17);
    put(6, c.users[last_user / 4], load<std::uint8_t>(record, 17), last_user);
    change(7, c.source, 20, 0);
    if (c.time_changed) {
      layers_[8].used = true;
      c.time.encode(layers_[8].out, load<std::int64_t>(record, 22));
    }
  }

  // LASzip 3 takes the channel of a point that does not change it for channel 0, and goes on from
  // the channel before where it changes to one that was there already.
  void encode_rest(std::string_view record, std::size_t channel) {
    std::string* last = &rests_[rest_now_]->last;
    if (!rests_[channel]) {
      rests_[channel] = std::make_unique<Rest14>(*last);
      last = &rests_[channel]->last;
    }
    rest_now_ = channel;
    Rest14& rest = *rests_[channel];
    std::size_t layer = 9;
    if (format_ >= 7) {
      const auto color = [](std::string_view bytes) { return bytes.substr(30, 6); };
      layers_[layer].used |= color(record) != color(*last);
      rest.color.encode(layers_[layer++].out, color(*last), color(record));
    }
    if (format_ == 8) encode_infrared(rest, record, *last, layers_[layer++]);
    for (std::size_t k = base_; k < record.size(); ++k, ++layer) {
      layers_[layer].used |= record[k] != (*last)[k];
      layers_[layer].out.symbol(rest.extra[k - base_],
                                static_cast<std::uint8_t>(record[k] - (*last)[k]));
    }
    *last = record;
  }

  static void encode_infrared(Rest14& rest, std::string_view record, std::string_view last,
                              Layer& layer) {
    const std::uint32_t changed =
        (record[36] != last[36] ? 1U : 0U) | (record[37] != last[37] ? 2U : 0U);
    layer.used |= changed != 0;
    layer.out.symbol(rest.infrared_changed, changed);
    for (std::size_t k = 0; k < 2; ++k) {
      if ((changed >> k & 1U) == 0) continue;
      layer.out.symbol(rest.infrared[k], static_cast<std::uint8_t>(record[36 + k] - last[36 + k]));
    }
  }

  int format_;
  std::size_t base_;
  std::vector<Layer> layers_;
  std::size_t now_;
  std::size_t rest_now_;
  std::array<std::unique_ptr<Channel14>, 4> channels_;
  std::array<std::unique_ptr<Rest14>, 4> rests_;
};

}  // namespace

std::string encode_chunk_14(int format, std::span<const std::string_view> records) {
  Encoder14 encoder(format, records[0]);
  for (const std::string_view record : records.subspan(1)) encoder.encode(record);
  return std::string(records[0]) + encoder.finish(static_cast<std::uint32_t>(records.size()));
}

}  // namespace palpate

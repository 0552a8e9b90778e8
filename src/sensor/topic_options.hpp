#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate::sensor {

/// What stands behind the name of a topic or bag: ",frame=FRAME,unit=METRES" in any order.
struct TopicOptions {
  std::string frame;           ///< empty: images are placed nowhere
  std::optional<double> unit;  ///< metres a step of depth or coordinate; none: as the type defines
};

/// Where options begin in `text`, or npos.
[[nodiscard]] std::size_t find_options(std::string_view text);

/// `options`: empty, or with its first comma. `form`: what they may stand behind, for messages.
/// @throws Error when one of them is none, or has no usable value.
[[nodiscard]] TopicOptions parse_topic_options(std::string_view options, std::string_view form);

}  // namespace palpate::sensor

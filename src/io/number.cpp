#include "io/number.hpp"

namespace palpate::io {

double load_number(NumberType type, const std::byte* bytes, std::endian order) {
  switch (type) {
    case NumberType::int8:
      return load_as<std::int8_t>(bytes, order);
    case NumberType::uint8:
      return load_as<std::uint8_t>(bytes, order);
    case NumberType::int16:
      return load_as<std::int16_t>(bytes, order);
    case NumberType::uint16:
      return load_as<std::uint16_t>(bytes, order);
    case NumberType::int32:
      return load_as<std::int32_t>(bytes, order);
    case NumberType::uint32:
      return load_as<std::uint32_t>(bytes, order);
    case NumberType::int64:
      return static_cast<double>(load_as<std::int64_t>(bytes, order));
    case NumberType::uint64:
      return static_cast<double>(load_as<std::uint64_t>(bytes, order));
    case NumberType::float32:
      return static_cast<double>(load_as<float>(bytes, order));
    case NumberType::float64:
      return load_as<double>(bytes, order);
  }
  return 0;
}

}  // namespace palpate::io

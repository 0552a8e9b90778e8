#include "io/number.hpp"

namespace palpate::io {

double load_number(NumberType type, const std::byte* bytes, std::endian order) {
  switch (type) {
    case NumberType::kInt8:
      return load_as<std::int8_t>(bytes, order);
    case NumberType::kUint8:
      return load_as<std::uint8_t>(bytes, order);
    case NumberType::kInt16:
      return load_as<std::int16_t>(bytes, order);
    case NumberType::kUint16:
      return load_as<std::uint16_t>(bytes, order);
    case NumberType::kInt32:
      return load_as<std::int32_t>(bytes, order);
    case NumberType::kUint32:
      return load_as<std::uint32_t>(bytes, order);
    case NumberType::kInt64:
      return static_cast<double>(load_as<std::int64_t>(bytes, order));
    case NumberType::kUint64:
      return static_cast<double>(load_as<std::uint64_t>(bytes, order));
    case NumberType::kFloat32:
      return static_cast<double>(load_as<float>(bytes, order));
    case NumberType::kFloat64:
      return load_as<double>(bytes, order);
  }
  return 0;
}

}  // namespace palpate::io

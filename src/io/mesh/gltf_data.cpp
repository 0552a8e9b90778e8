// Finds the data that a glTF file names: in itself, in its binary chunk, in files beside it.
#include "io/mesh/gltf_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "io/mesh/gltf_uri.hpp"

namespace palpate::io {

using nlohmann::json;

namespace {

constexpr std::string_view kAgain = "The file is damaged: export it again";

// Bytes of GLB's header and of a chunk's, and marks of chunks: the format's.
constexpr std::size_t kGlbHead = 12;
constexpr std::size_t kChunkHead = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

// Extensions that leave positions and indices as they are, by how their names begin.
// The last two are read, the very last as points.
constexpr std::array<std::string_view, 7> kHarmless{
    "KHR_materials_",        "KHR_texture_",          "KHR_lights_",
    "EXT_texture_",          "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
    "KHR_gaussian_splatting"};

std::optional<NumberType> number_type(std::size_t component) {
  constexpr std::array<std::optional<NumberType>, 7> kComponents{
      NumberType::int8, NumberType::uint8,  NumberType::int16,  NumberType::uint16,
      std::nullopt,     NumberType::uint32, NumberType::float32};
  constexpr std::size_t kFirst = 5120;  // BYTE (format)
  const std::size_t i = component - kFirst;
  return component < kFirst || i >= kComponents.size() ? std::nullopt : kComponents[i];
}

std::size_t width_of(const json* type) {
  constexpr std::array<std::string_view, 4> kWidths{"SCALAR", "VEC2", "VEC3", "VEC4"};
  if (type == nullptr || !type->is_string()) return 0;
  if (*type == "MAT4") return 16;
  const auto* const found = std::ranges::find(kWidths, type->get_ref<const std::string&>());
  return found == kWidths.end() ? 0 : static_cast<std::size_t>(found - kWidths.begin()) + 1;
}

// A value in a message. Arrays and objects may be nested too deeply to be written.
std::string shown(const json& value) {
  return value.is_structured() ? value.type_name() : excerpt(value.dump());
}

}  // namespace

double GltfNumbers::at(std::size_t row, std::size_t column) const {
  const double value = load_number(type, begin + row * stride + column * size_of(type));
  if (!normalized) return value;
  const bool is_signed = type == NumberType::int8 || type == NumberType::int16;
  const double most = std::exp2(8.0 * static_cast<double>(size_of(type)) - (is_signed ? 1 : 0)) - 1;
  return std::max(value / most, -1.0);
}

const json* find_member(const json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

GltfFile::GltfFile(const Input& input) : input_(input) {
  parse(input.text().starts_with("glTF") ? unpack_glb() : input.text());
  const json* asset = find_member(root_, "asset");
  const json* version = asset == nullptr ? nullptr : find_member(*asset, "version");
  const bool is_2 = version != nullptr && version->is_string() &&
                    version->get_ref<const std::string&>().starts_with("2.");
  if (!is_2) fail(input_, "this is JSON, but not glTF 2", "Export it again as glTF 2.0 or GLB");
  check_extensions();
  buffers_.resize(list("buffers").size());
}

std::string_view GltfFile::unpack_glb() {
  const auto number = [&](std::size_t at) { return load_as<std::uint32_t>(&input_.bytes[at]); };
  if (input_.bytes.size() >= kGlbHead && number(4) == 1) {
    fail(input_, "this is binary glTF of version 1", "Export it again as GLB of glTF 2.0");
  }
  std::string_view text;
  std::size_t at = kGlbHead;
  for (int chunk = 0; chunk < 2; ++chunk) {
    if (chunk == 1 && at == input_.bytes.size()) break;  // without data of its own
    const bool has_head = at + kChunkHead <= input_.bytes.size();
    const std::size_t size = has_head ? number(at) : 0;
    if (!has_head || input_.bytes.size() - at - kChunkHead < size) {
      fail_at_byte(input_, input_.bytes.size(), "the file ends inside a part of GLB",
                   "Download or export it again");
    }
    const std::uint32_t kind = number(at + 4);
    at += kChunkHead;
    if (chunk == 0 && kind != kJsonChunk) fail_at_byte(input_, at, "no JSON begins here", kAgain);
    if (chunk == 0) text = input_.text().substr(at, size);
    if (chunk == 1 && kind == kBinaryChunk) chunk_ = input_.bytes.subspan(at, size);
    at += size;
  }
  return text;
}

void GltfFile::parse(std::string_view text) {
  try {
    root_ = json::parse(text);
  } catch (const json::exception&) {
    fail(input_, "its JSON is broken", "Download or export it again");
  }
}

void GltfFile::check_extensions() const {
  for (const json& each : list("extensionsRequired")) {
    const std::string name = each.is_string() ? each.get<std::string>() : "";
    const auto begins = [&](std::string_view start) { return name.starts_with(start); };
    if (std::ranges::any_of(kHarmless, begins)) continue;
    fail(input_, fmt::format("the extension \"{}\" of glTF is not supported", excerpt(name)),
         "Export it without compression (Draco, meshopt) and without extensions");
  }
}

const json& GltfFile::list(const char* name) const {
  const json* found = find_member(root_, name);
  return found != nullptr && found->is_array() ? *found : no_list_;
}

const json& GltfFile::element(const char* name, std::size_t index) const {
  const json& elements = list(name);
  if (index < elements.size()) return elements[index];
  wrong(fmt::format("\"{}\" has {} elements, and number {} is asked for", name, elements.size(),
                    index));
}

std::optional<std::size_t> GltfFile::whole(const json& object, const char* name) const {
  const json* found = find_member(object, name);
  if (found == nullptr) return {};
  constexpr double kMost = 9007199254740992.0;  // 2^53: doubles are exact up to there (derived)
  const double number = found->is_number() ? found->get<double>() : -1;
  if (!(number >= 0 && number <= kMost && std::floor(number) == number)) {
    wrong(fmt::format("\"{}\" is {}, not a count", name, shown(*found)));
  }
  return static_cast<std::size_t>(number);
}

std::vector<std::size_t> GltfFile::indices(const json& object, const char* name) const {
  std::vector<std::size_t> result;
  const json* found = find_member(object, name);
  if (found == nullptr || !found->is_array()) return result;
  for (const json& each : *found) {
    if (!each.is_number_unsigned()) wrong(fmt::format("\"{}\" are not all counts", name));
    result.push_back(each.get<std::size_t>());
  }
  return result;
}

bool GltfFile::fill(const json& object, const char* name, std::span<double> values) const {
  const json* found = find_member(object, name);
  if (found == nullptr) return false;
  bool good = found->is_array() && found->size() == values.size();
  for (std::size_t i = 0; good && i < values.size(); ++i) {
    good = (*found)[i].is_number();
    if (good) values[i] = (*found)[i].get<double>();
  }
  if (!good) wrong(fmt::format("\"{}\" is not {} numbers", name, values.size()));
  return true;
}

GltfNumbers GltfFile::numbers(std::size_t index) {
  const json& accessor = element("accessors", index);
  const std::string name = fmt::format("accessor {}", index);
  const std::optional<std::size_t> in = whole(accessor, "bufferView");
  if (find_member(accessor, "sparse") != nullptr || !in) {
    fail(input_, name + " is sparse, compressed or without data, which is not supported",
         "Export it without compression (Draco, meshopt) and without morph targets");
  }
  GltfNumbers numbers;
  const auto type = number_type(whole(accessor, "componentType").value_or(0));
  numbers.width = width_of(find_member(accessor, "type"));
  if (!type || numbers.width == 0) wrong(name + " has no known type");
  numbers.type = *type;
  const json* normalized = find_member(accessor, "normalized");
  numbers.normalized = normalized != nullptr && *normalized == true && !is_floating(*type);
  numbers.count = whole(accessor, "count").value_or(0);
  const std::span<const std::byte> bytes = view(*in);
  const std::size_t row = numbers.width * size_of(*type);
  numbers.stride = whole(element("bufferViews", *in), "byteStride").value_or(row);
  const std::size_t offset = whole(accessor, "byteOffset").value_or(0);
  const std::size_t rest = offset < bytes.size() ? bytes.size() - offset : 0;
  const std::size_t rows =
      rest < row || numbers.stride < row ? 0 : (rest - row) / numbers.stride + 1;
  if (rows < numbers.count) {
    wrong(fmt::format("{} has {} rows, but bytes for {}", name, numbers.count, rows));
  }
  if (numbers.count > 0) numbers.begin = bytes.data() + offset;
  return numbers;
}

std::span<const std::byte> GltfFile::view(std::size_t index) {
  const json& view = element("bufferViews", index);
  const std::span<const std::byte> bytes = buffer(whole(view, "buffer").value_or(0));
  const std::size_t offset = whole(view, "byteOffset").value_or(0);
  const std::size_t size = whole(view, "byteLength").value_or(0);
  if (offset > bytes.size() || bytes.size() - offset < size) {
    wrong(
        fmt::format("bufferView {} reaches to byte {} of {}", index, offset + size, bytes.size()));
  }
  return bytes.subspan(offset, size);
}

std::span<const std::byte> GltfFile::buffer(std::size_t index) {
  const json* uri = find_member(element("buffers", index), "uri");
  if (uri == nullptr || !uri->is_string()) return chunk_;
  std::optional<std::span<const std::byte>>& bytes = buffers_[index];
  if (bytes) return *bytes;
  const std::string& text = uri->get_ref<const std::string&>();
  if (text.starts_with("data:")) {
    bytes = std::as_const(embedded_.emplace_back(decode(text))).span();
  } else {
    bytes = file_beside(text);
  }
  return *bytes;
}

Bytes GltfFile::decode(std::string_view uri) const {
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  std::optional<Bytes> bytes;
  if (mark != std::string_view::npos) bytes = decode_base64(uri.substr(mark + kMark.size()));
  if (!bytes) wrong("a data URI is not base64");
  return std::move(*bytes);
}

// Read once, however many buffers name it.
std::span<const std::byte> GltfFile::file_beside(const std::string& uri) {
  const std::filesystem::path path = path_of_uri(uri);
  const std::string name = excerpt(path.string());
  if (input_.folder.empty()) {
    fail(input_, fmt::format("its data lie in another file, \"{}\"", name),
         "Give the file by its path, or export it as GLB, which holds all data");
  }
  const auto file = path_inside(input_.folder, path);
  if (!file) {
    fail(input_, fmt::format("its data lie in \"{}\", outside its folder", name),
         "Export it as GLB, which holds all data");
  }
  std::error_code unknown;
  if (!is_regular_file(*file, unknown)) {
    fail(input_, fmt::format("its data lie in \"{}\", which is not beside it", name),
         "Put both into one folder, or export it as GLB, which holds all data");
  }
  const auto [found, is_new] = files_.try_emplace(*file);
  if (is_new) found->second = read_bytes(*file);
  return std::as_const(found->second).span();
}

void GltfFile::wrong(std::string_view what) const {
  fail(input_, what, kAgain);
}

}  // namespace palpate::io

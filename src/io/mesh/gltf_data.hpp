#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

/// Numbers that an accessor of a glTF file names, in rows of `width`. All of them are there.
struct GltfNumbers {
  const std::byte* begin = nullptr;
  std::size_t count = 0;   ///< rows
  std::size_t width = 0;   ///< numbers a row
  std::size_t stride = 0;  ///< bytes from a row to the next
  NumberType type = NumberType::float32;
  bool normalized = false;  ///< integers stand for 0 ... 1, or -1 ... 1

  [[nodiscard]] double at(std::size_t row, std::size_t column) const;
};

/// A member of a JSON object; null: it has none of that name, or is no object.
[[nodiscard]] const nlohmann::json* find_member(const nlohmann::json& object, const char* name);

/// The JSON of a glTF or GLB file, and the data that it names.
class GltfFile {
 public:
  /// @throws Error for what is no glTF 2.0, and for extensions that are required and not supported.
  explicit GltfFile(const Input& input);

  /// The list `name` of the file, such as "meshes"; empty without one.
  [[nodiscard]] const nlohmann::json& list(const char* name) const;
  /// Element `index` of that list. @throws Error where it has none.
  [[nodiscard]] const nlohmann::json& element(const char* name, std::size_t index) const;
  /// A whole number that is a member. @throws Error where it is none.
  [[nodiscard]] std::optional<std::size_t> whole(const nlohmann::json& object,
                                                 const char* name) const;
  /// The counts in a list that is a member; none without one. @throws Error for others.
  [[nodiscard]] std::vector<std::size_t> indices(const nlohmann::json& object,
                                                 const char* name) const;
  /// Makes `values` a list of as many numbers. False: it is not there. @throws Error for another.
  bool fill(const nlohmann::json& object, const char* name, std::span<double> values) const;
  /// Numbers of accessor `index`, which stay where they are as long as this object.
  /// @throws Error for sparse and compressed ones, and for data that is not there.
  [[nodiscard]] GltfNumbers numbers(std::size_t index);

  [[nodiscard]] const nlohmann::json& root() const { return root_; }
  [[noreturn]] void wrong(std::string_view what) const;

 private:
  [[nodiscard]] std::string_view unpack_glb();
  void parse(std::string_view text);
  void check_extensions() const;
  [[nodiscard]] std::span<const std::byte> view(std::size_t index);
  [[nodiscard]] std::span<const std::byte> buffer(std::size_t index);
  [[nodiscard]] Bytes decode(std::string_view uri) const;
  [[nodiscard]] std::span<const std::byte> file_beside(const std::string& uri);

  const Input& input_;
  nlohmann::json root_;
  nlohmann::json no_list_ = nlohmann::json::array();
  std::span<const std::byte> chunk_;                                // of a GLB file
  std::vector<std::optional<std::span<const std::byte>>> buffers_;  // once they were requested
  std::deque<Bytes> embedded_;                                      // of data URIs
  std::map<std::filesystem::path, Bytes> files_;                    // by their true paths
};

}  // namespace palpate::io

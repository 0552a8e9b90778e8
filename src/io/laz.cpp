// Loads LASzip at run time and reads the points of LAZ files with it.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/shared_library.hpp"
#include "io/cloud_builder.hpp"
#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io {
namespace {

// Offsets into laszip_point_struct of LASzip 3.
constexpr std::size_t kIntensityAt = 12;
constexpr std::size_t kFlagsAt = 15;          // withheld: bit 7
constexpr std::size_t kExtendedFlagsAt = 22;  // withheld: bit 6
constexpr std::size_t kColorAt = 40;

// The functions of LASzip's C interface (laszip_api.h of LASzip 3) that are used here. All return 0
// when they succeed.
struct LaszipLibrary {
  using Handle = void*;

  // Throws Error when `name` cannot be loaded or lacks a function.
  explicit LaszipLibrary(const std::string& name)
      : library({name}, "", SharedLibrary::Unload::with_the_last_copy) {}

  SharedLibrary library;
  int (*create)(Handle*) = library["laszip_create"];
  int (*destroy)(Handle) = library["laszip_destroy"];
  int (*open_reader)(Handle, const char* file, int* is_compressed) = library["laszip_open_reader"];
  int (*close_reader)(Handle) = library["laszip_close_reader"];
  int (*get_point_pointer)(Handle, std::byte** point) = library["laszip_get_point_pointer"];
  int (*read_point)(Handle) = library["laszip_read_point"];
  int (*get_error)(Handle, char** message) = library["laszip_get_error"];
};

std::optional<LaszipLibrary> load_laszip(std::span<const std::string> names) {
  for (const std::string& name : names) {
    try {
      return LaszipLibrary(name);
    } catch (const Error&) {  // perhaps the next one loads
    }
  }
  return std::nullopt;
}

class LazReader {
 public:
  LazReader(const Input& input, const LasHeader& header, const LaszipLibrary& library)
      : input_(input), header_(header), library_(library), file_(input.bytes) {
    if (library_.create(&handle_) != 0) fail(input, "LASzip cannot start", "Reinstall it");
  }
  LazReader(const LazReader&) = delete;
  LazReader& operator=(const LazReader&) = delete;
  ~LazReader() {
    if (open_) library_.close_reader(handle_);
    library_.destroy(handle_);
  }

  CloudFile run() {
    int compressed = 0;
    check(library_.open_reader(handle_, file_.path().c_str(), &compressed), 0);
    open_ = true;
    std::byte* point = nullptr;
    check(library_.get_point_pointer(handle_, &point), 0);
    const bool colors = header_.color_offset().has_value();
    CloudBuilder builder(input_, {.colors = colors, .intensities = true}, ColorScale::guess_integer,
                         std::min(header_.points, input_.bytes.size()));
    Progress progress(input_.options, header_.points);
    for (std::size_t i = 0; i < header_.points; ++i) {
      progress.at(i);
      check(library_.read_point(handle_), i);
      if (!is_withheld(point)) builder.add(row_of(point));
    }
    CloudFile file = builder.finish(header_.name());
    file.declared = header_.points;
    file.dropped = header_.points - file.cloud.size();
    return file;
  }

 private:
  bool is_withheld(const std::byte* point) const {
    return header_.extended() ? (point[kExtendedFlagsAt] & std::byte{64}) != std::byte{0}
                              : (point[kFlagsAt] & header_.withheld_mask()) != std::byte{0};
  }

  Row row_of(const std::byte* point) const {
    Row row{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      row[axis] = load_as<std::int32_t>(point + 4 * axis) * header_.scale[k] + header_.offset[k];
      row[index_of(Role::red) + axis] = load_as<std::uint16_t>(point + kColorAt + 2 * axis);
    }
    row[index_of(Role::intensity)] = load_as<std::uint16_t>(point + kIntensityAt);
    return row;
  }

  void check(int status, std::size_t present) const {
    if (status == 0) return;
    char* message = nullptr;
    library_.get_error(handle_, &message);
    fail(input_,
         fmt::format("LASzip stopped after {} of {} points: {}", present, header_.points,
                     excerpt(message == nullptr ? "no reason given" : message)),
         "Download the file again; \"lasinfo\" or \"pdal info\" tests it");
  }

  const Input& input_;
  const LasHeader& header_;
  const LaszipLibrary& library_;
  MemoryFile file_;
  LaszipLibrary::Handle handle_ = nullptr;
  bool open_ = false;
};

}  // namespace

CloudFile read_laz(const Input& input, const LasHeader& header,
                   std::span<const std::string> libraries) {
  const std::optional<LaszipLibrary> library = load_laszip(libraries);
  if (!library) {
    fail(input,
         fmt::format("{} points compressed as LAZ, but LASzip (liblaszip.so.8) is not installed",
                     header.points),
         "Convert the file with \"pdal translate IN.laz OUT.las\" or \"laszip -i IN.laz -o "
         "OUT.las\" and read the .las, or install LASzip 3 where the loader finds it "
         "(LD_LIBRARY_PATH)");
  }
  return LazReader(input, header, *library).run();
}

}  // namespace palpate::io

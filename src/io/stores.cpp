// Opens point stores of any kind.
#include "io/copc.hpp"
#include "palpate/io/files.hpp"

namespace palpate {

std::shared_ptr<const PointStore> open_store(const std::filesystem::path& path, double scale) {
  std::error_code none;
  const bool may_be_copc = io::extension(path.string()) == ".laz";
  if (!may_be_copc || !std::filesystem::is_regular_file(path, none)) return nullptr;
  return io::open_copc(path, scale);
}

}  // namespace palpate

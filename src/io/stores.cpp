// Opens point stores of any kind.
#include <system_error>

#include "io/copc.hpp"
#include "io/potree/potree.hpp"
#include "palpate/io/files.hpp"

namespace palpate {

std::shared_ptr<const PointStore> open_store(const std::filesystem::path& path,
                                             const ReadOptions& options) {
  if (io::is_potree(path)) return io::open_potree(path, options);
  std::error_code none;
  const bool may_be_copc = io::extension(path.string()) == ".laz";
  if (!may_be_copc || !std::filesystem::is_regular_file(path, none)) return nullptr;
  return io::open_copc(path, options);
}

}  // namespace palpate

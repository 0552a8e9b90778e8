#pragma once

#include <string>

namespace palpate {

/// Metres a unit of a file's coordinates, and what says so.
struct FileUnit {
  enum class Source {
    assumed,  ///< nothing: metres
    likely,   ///< the size of a mesh
    stated,   ///< the file
    given     ///< the caller
  };
  double plan = 1;    ///< m a unit of x and y
  double height = 1;  ///< m a unit of z
  Source source = Source::assumed;
  bool height_stated = true;  ///< false: the file states that of x and y alone
  std::string words{};        ///< what states it, or why it is likely; of a given one what differs
};

}  // namespace palpate

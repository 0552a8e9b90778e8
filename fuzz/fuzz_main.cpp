// The libFuzzer program of all readers. The name by which it is started says which reader it
// fuzzes: fuzz_NAME.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "targets.hpp"

namespace {

std::string reader;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
  const std::string_view path = **arguments;
  reader = path.substr(path.rfind("fuzz_") + 5);
  const auto names = palpate::fuzz::target_names();
  if (path.rfind("fuzz_") != path.npos && std::ranges::count(names, reader) > 0) return 0;
  std::fprintf(stderr, "no reader is called '%s': start this program as fuzz_NAME\n", **arguments);
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::fuzz::run_target(reader, std::as_bytes(std::span(data, size)));
  return 0;
}

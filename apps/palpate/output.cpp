#include "apps/palpate/output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "palpate/base/error.hpp"

namespace palpate::app {

void OutputFile::Closer::operator()(std::FILE* file) const {
  if (file != stdout) std::fclose(file);
}

OutputFile::OutputFile(const std::string& path)
    : path_(path == "-" ? "standard output" : path),
      file_(path == "-" ? stdout : std::fopen(path.c_str(), "wb")) {
  if (!file_) fail("cannot be made");
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) {
    fail("cannot be written");
  }
}

void OutputFile::close() {
  if (std::fflush(file_.get()) != 0) fail("cannot be written");
  if (file_.get() == stdout) return;
  if (std::fclose(file_.release()) != 0) fail("cannot be written");
}

void OutputFile::fail(const char* what) const {
  throw Error(fmt::format("{} {}: {}; choose another place", path_, what, std::strerror(errno)));
}

}  // namespace palpate::app

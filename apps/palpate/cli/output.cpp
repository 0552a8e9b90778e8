// Output files that appear only when they are complete.
#include "apps/palpate/cli/output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "apps/palpate/cli/errors.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

namespace fs = std::filesystem;

bool as_it_is(const std::string& path) {
  std::error_code ignored;
  return path == "-" || (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored));
}

// The absolute path, with links followed; empty where there is none, as in a removed folder.
fs::path whole_path(const std::string& path) {
  std::error_code failed;
  const fs::path whole = fs::absolute(path, failed);
  const fs::path resolved = failed ? fs::path() : fs::weakly_canonical(whole, failed);
  return failed ? fs::path() : resolved;
}

std::string where_links_lead(const std::string& path) {
  const fs::path resolved = whole_path(path);
  return resolved.empty() ? path : resolved.string();
}

// A file that may not be written must not be replaced either.
bool protects_itself(const std::string& path) {
  return access(path.c_str(), F_OK) == 0 && access(path.c_str(), W_OK) != 0;
}

bool is_plain(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || path == "-") return false;
  return !fs::exists(path, ignored) || fs::is_regular_file(path, ignored);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed) && !failed) return true;  // two names of one file
  const fs::path resolved = whole_path(a);
  return resolved.empty() ? a == b : resolved == whole_path(b);
}

}  // namespace

void OutputFile::Closer::operator()(std::FILE* file) const {
  if (file != stdout) std::fclose(file);
}

OutputFile::OutputFile(const std::string& path, Unfinished unfinished)
    : path_(path == "-" ? "standard output" : path),
      target_(path),
      growing_(path),
      stays_(unfinished == Unfinished::stays && path != "-" && !as_it_is(path)) {
  if (path == "-") {
    file_.reset(stdout);
    return;
  }
  if (!as_it_is(path)) {
    target_ = where_links_lead(path);
    if (protects_itself(target_)) fail("cannot be written");
    growing_ = target_ + (stays_ ? ".part" : fmt::format(".part-{}", getpid()));
  }
  open();
  if (growing_ == target_ || nameless_) return;
  file_.reset();
  std::remove(growing_.c_str());
}

OutputFile::~OutputFile() {
  if (file_ && growing_ != target_ && !nameless_ && !stays_) std::remove(growing_.c_str());
}

void OutputFile::open() {
  if (file_ || open_nameless()) return;
  open_named();
  if (!file_) fail("cannot be created");
  if (stays_) std::setvbuf(file_.get(), nullptr, _IONBF, 0);
}

void OutputFile::open_named() {
  const char* mode = growing_ == target_ ? "wb" : "wbx";
  file_.reset(std::fopen(growing_.c_str(), mode));
  for (int i = 2; !file_ && stays_ && errno == EEXIST; ++i) {
    growing_ = fmt::format("{}.part-{}", target_, i);
    file_.reset(std::fopen(growing_.c_str(), mode));
  }
}

// Opens a file without a name, which vanishes however the program ends. Some file systems cannot.
bool OutputFile::open_nameless() {
  if (stays_ || growing_ == target_ || access("/proc/self/fd", F_OK) != 0) return false;
  const std::string folder = fs::path(target_).parent_path().string();
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  file_.reset(fdopen(descriptor, "wb"));
  nameless_ = file_ != nullptr;
  if (!nameless_) ::close(descriptor);
  return nameless_;
}

// linkat() does not replace what is there, rename() does.
bool OutputFile::name() {
  const std::string itself = fmt::format("/proc/self/fd/{}", fileno(file_.get()));
  return linkat(AT_FDCWD, itself.c_str(), AT_FDCWD, growing_.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

std::string OutputFile::growing() {
  open();
  if (!nameless_) return growing_;
  const int descriptor = fileno(file_.get());
  fcntl(descriptor, F_SETFD, 0);  // the other program has it by the same number
  return fmt::format("/dev/fd/{}", descriptor);
}

void OutputFile::write(std::string_view text) {
  open();
  const std::size_t written = std::fwrite(text.data(), 1, text.size(), file_.get());
  if (written == text.size()) return;
  const int reason = errno;
  if (stays_) keep_lines(text.substr(0, written));
  errno = reason;
  fail("cannot be written");
}

// `last` is what was written last: lines came before it.
void OutputFile::keep_lines(std::string_view last) {
  const std::size_t cut = last.size() - (last.rfind('\n') + 1);
  const int file = fileno(file_.get());
  if (ftruncate(file, lseek(file, 0, SEEK_CUR) - static_cast<off_t>(cut)) != 0) return;
}

void OutputFile::close() {
  open();
  if (std::fflush(file_.get()) != 0) fail("cannot be written");
  if (file_.get() == stdout) return;
  if (nameless_ && !name()) fail("cannot be written");
  if (stays_ && fdatasync(fileno(file_.get())) != 0) fail("cannot be written");
  const bool closed = std::fclose(file_.release()) == 0;
  if (growing_ == target_) {
    if (!closed) fail("cannot be written");
    return;
  }
  if (closed && std::rename(growing_.c_str(), target_.c_str()) == 0) return;
  const int reason = errno;
  if (!stays_) std::remove(growing_.c_str());
  errno = reason;
  fail("cannot be written");
}

void OutputFile::fail(const char* what) const {
  const int reason = errno;
  const bool kept = stays_ && growing_ != path_ && access(growing_.c_str(), F_OK) == 0;
  throw Error(fmt::format(
      "{} {}: {}; {}", path_, what, std::strerror(reason),
      kept ? "what was written before is in " + growing_ : std::string("choose another path")));
}

std::optional<OutputFile> output_at(const std::string& path) {
  return path.empty() ? std::nullopt : std::make_optional<OutputFile>(path);
}

void write_whole(std::optional<OutputFile>& file, std::string_view text) {
  if (!file) return;
  file->write(text);
  file->close();
}

void write_whole(const std::string& path, std::string_view text) {
  std::optional<OutputFile> file = output_at(path);
  write_whole(file, text);
}

std::string numbered_path(const std::string& path, std::size_t hand) {
  if (hand == 0 || path.empty()) return path;
  const std::filesystem::path plain(path);
  const std::string name =
      fmt::format("{}-{}{}", plain.stem().string(), hand + 1, plain.extension().string());
  return (plain.parent_path() / name).string();
}

std::vector<NamedFile> inputs(const std::vector<CloudArgument>& clouds) {
  std::vector<NamedFile> result;
  for (const CloudArgument& cloud : clouds) {
    const std::string name = fmt::format("the source '{}'", cloud.name);
    const std::string path = file_of(cloud.path);
    result.push_back({name, path});
    std::error_code none;
    for (const auto& file : std::filesystem::directory_iterator(path, none))
      result.push_back({name, file.path().string()});
  }
  return result;
}

void check_distinct(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
  std::vector<NamedFile> others = inputs;
  for (const NamedFile& output : outputs) {
    if (!is_plain(output.path)) continue;
    for (const NamedFile& other : others) {
      if (!is_plain(other.path) || !same_file(output.path, other.path)) continue;
      throw UsageError(fmt::format("{} {} is the same file as {}; choose another path", output.name,
                                   output.path, other.name));
    }
    others.push_back(output);
  }
}

}  // namespace palpate::app

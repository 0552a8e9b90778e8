// Opens what a tab touches or replays.
#include "tab/tab_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <span>
#include <utility>

#include "bag/random_file.hpp"
#include "tab/tab_program.hpp"
#include "tab/tab_replay.hpp"

namespace palpate::tab {
namespace {

bool is_bag(std::span<const std::byte> bytes, const std::string& name) {
  const auto same = [](std::byte byte, std::uint8_t sign) {
    return std::to_integer<std::uint8_t>(byte) == sign;
  };
  const auto head = bytes.first(std::min(bytes.size(), bag::kMagic.size()));
  return std::ranges::equal(head, bag::kMagic, same) ||
         std::filesystem::path(name).extension() == ".mcap";
}

}  // namespace

std::unique_ptr<TabRun> open_run(const std::string& name, FileBytes file, Outside outside,
                                 const Clock& stopwatch, std::string news) {
  const std::span bytes(file.bytes.get(), file.size);
  if (file.bytes && is_bag(bytes, name)) {
    bag::RandomFile bag(name, std::move(file.bytes), file.size);
    return std::make_unique<TabReplay>(std::move(bag), std::move(outside), stopwatch, news);
  }
  Touched touched = file.bytes ? of_file(bytes, name, file.unit) : simulated(name);
  file.bytes.reset();  // before the cloud is prepared
  return std::make_unique<TabProgram>(std::move(touched), std::move(outside), stopwatch,
                                      std::move(news));
}

std::string words_of(const std::exception& error, const std::string& name) {
  if (dynamic_cast<const std::bad_alloc*>(&error) == nullptr) return error.what();
  return fmt::format("{} needs more memory than a tab may use; the program palpate can open it",
                     name);
}

}  // namespace palpate::tab

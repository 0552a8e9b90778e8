// Options of recordings with a wrong value: they are refused with a reason, or taken as they are
// written, and never as something else.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "palpate/base/error.hpp"
#include "session/options_json.hpp"
#include "support/effort.hpp"

namespace palpate::session {
namespace {

constexpr std::array<const char*, 24> kWrong = {
    "null",     "true",    "false", "0",     "-1",      "1.5",        "1e300",       "4294967296",
    "-2e9",     "\"abc\"", "\"\"",  "\"1\"", "\"nan\"", "\"inf\"",    "\"-inf\"",    "\"1 m\"",
    "\"0x10\"", "\" 2\"",  "[]",    "[1]",   "{}",      "{\"a\": 1}", "[[1, 2], 3]", "\"\\u0000\""};

/// Does `read` hold what was written? A number may be written as a text.
bool is_same(const Json& read, const Json& written) {
  if (read == written) return true;
  if (written.is_string() && read.is_number())
    return parse_number(written.get<std::string>()) == read.get<double>();
  if (written.is_number() && read.is_string()) return true;  // a choice of an earlier version
  return written.is_object() && read.is_object();  // what it does not name keeps its default
}

template <class Options>
void mutate(unsigned seed, int& refused) {
  std::mt19937 random(seed);
  Json json = exact_json(Options());
  const Json flat = json.flatten();
  auto leaf = flat.begin();
  std::advance(leaf, random() % flat.size());
  const Json::json_pointer at(leaf.key());
  const Json wrong = Json::parse(kWrong[random() % kWrong.size()]);
  json[at] = wrong;
  Options read;
  try {
    take_exact(json, read);
  } catch (const std::exception& error) {
    ++refused;
    EXPECT_GT(std::string(error.what()).size(), 10u);
    return;
  }
  const Json again = exact_json(read);
  const bool same = again.contains(at) && is_same(again[at], wrong);
  EXPECT_TRUE(same || wrong.is_null()) << leaf.key() << " " << wrong << " became " << again;
}

TEST(WrongOptions, AreRefusedOrTakenAsTheyAreWritten) {
  int refused = 0;
  const int runs = test::effort(2000);
  for (int run = 0; run < runs; ++run) {
    const auto seed = static_cast<unsigned>(run);
    if (run % 3 == 0) mutate<ServoOptions>(seed, refused);
    if (run % 3 == 1) mutate<SourceOptions>(seed, refused);
    if (run % 3 == 2) mutate<FieldOptions>(seed, refused);
  }
  EXPECT_GT(refused, runs / 2);
}

}  // namespace
}  // namespace palpate::session

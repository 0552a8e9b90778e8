// What a worker calls of the program, and what the program calls of it.
#include <emscripten.h>

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "palpate/base/clock.hpp"
#include "tab/tab_run.hpp"

// clang-format off
EM_JS(void, tab_say, (const char* bytes, int size, int text), {
  Module.say(HEAPU8.subarray(bytes, bytes + size), text !== 0);
});
EM_JS(void, tab_close, (int code, const char* why), { Module.close(code, UTF8ToString(why)); });
EM_JS(void, tab_another, (const char* name), { Module.open(UTF8ToString(name)); });
EM_JS(void, tab_again, (double unit), { Module.openAgain(unit); });
// clang-format on

namespace {

using namespace palpate::tab;

std::unique_ptr<TabRun> program;
std::string words;                     // of what went wrong last
const palpate::SteadyClock stopwatch;  // of computing times

Outside worker() {
  return {[](std::string_view bytes, bool text) {
            tab_say(bytes.data(), static_cast<int>(bytes.size()), text ? 1 : 0);
          },
          [](int code, const std::string& why) { tab_close(code, why.c_str()); },
          [](const std::string& name) { tab_another(name.c_str()); },
          [](double unit) { tab_again(unit); }};
}

const char* ended_by(const std::function<void()>& act) {
  try {
    act();
    return nullptr;
  } catch (const std::exception& error) {
    words = words_of(error, "what is touched");
  }
  return words.c_str();
}

}  // namespace

extern "C" {

// The file of that name, metres a unit of it (0: the likely one); null: a synthetic cloud. Takes
// over the bytes, which malloc() got. null: it is touched; else what is wrong.
EMSCRIPTEN_KEEPALIVE const char* tab_open(const char* name, const std::byte* bytes, int size,
                                          double unit, const char* news) {
  try {
    const auto forget = [](const std::byte* given) { std::free(const_cast<std::byte*>(given)); };
    FileBytes file{{bytes, forget}, static_cast<std::size_t>(size), unit};
    program = open_run(name, std::move(file), worker(), stopwatch, news);
    return nullptr;
  } catch (const std::exception& error) {
    words = words_of(error, name);
  }
  return words.c_str();
}

// These return null, or what ended the program.
EMSCRIPTEN_KEEPALIVE const char* tab_connect(double now) {
  return ended_by([now] { program->connect(now); });
}
EMSCRIPTEN_KEEPALIVE const char* tab_receive(const char* text, double now) {
  return ended_by([text, now] { program->receive(text, now); });
}
EMSCRIPTEN_KEEPALIVE const char* tab_run(double now) {
  return ended_by([now] { program->run(now); });
}

}  // extern "C"

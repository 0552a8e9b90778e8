// What a worker calls of the program, and what the program calls of it.
#include <emscripten.h>
#include <fmt/format.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "tab/tab_program.hpp"

// clang-format off
EM_JS(void, tab_say, (const char* bytes, int size, int text), {
  Module.say(HEAPU8.subarray(bytes, bytes + size), text !== 0);
});
EM_JS(void, tab_close, (int code, const char* why), { Module.close(code, UTF8ToString(why)); });
EM_JS(void, tab_another, (const char* name), { Module.open(UTF8ToString(name)); });
// clang-format on

namespace {

using namespace palpate::tab;

std::unique_ptr<TabProgram> program;
std::string words;  // of what went wrong last

Outside worker() {
  return {[](std::string_view bytes, bool text) {
            tab_say(bytes.data(), static_cast<int>(bytes.size()), text ? 1 : 0);
          },
          [](int code, const std::string& why) { tab_close(code, why.c_str()); },
          [](const std::string& name) { tab_another(name.c_str()); }};
}

}  // namespace

extern "C" {

// The file of that name and bytes; null: a synthetic cloud. null: it is touched; else what is
// wrong.
EMSCRIPTEN_KEEPALIVE const char* tab_open(const char* name, const std::byte* bytes, int size,
                                          const char* news) {
  try {
    Touched touched =
        bytes != nullptr ? of_file({bytes, static_cast<std::size_t>(size)}, name) : synthetic(name);
    program = std::make_unique<TabProgram>(std::move(touched), worker(), news);
    return nullptr;
  } catch (const std::bad_alloc&) {
    words = fmt::format("{} needs more memory than a tab may use; the program palpate can open it",
                        name);
  } catch (const std::exception& error) {
    words = error.what();
  }
  return words.c_str();
}

EMSCRIPTEN_KEEPALIVE void tab_connect(double now) {
  program->connect(now);
}
EMSCRIPTEN_KEEPALIVE void tab_receive(const char* text, double now) {
  program->receive(text, now);
}
EMSCRIPTEN_KEEPALIVE int tab_run(double now) {
  return program->run(now);
}

}  // extern "C"

// Replaces the page in builds without npm.
#include <array>

#include "viewer/server.hpp"

namespace palpate::viewer {
namespace {

constexpr std::string_view kText = R"(<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>palpate</title></head>
<body>
<h1>The page was not built</h1>
<p>The program runs and its socket answers, but this build has no page: npm was not found, or
<code>PALPATE_BUILD_PAGE</code> was off.</p>
<p>Install Node.js 18 or newer with npm, then in palpate's folder:</p>
<pre>cmake --preset release -DPALPATE_BUILD_PAGE=ON
cmake --build --preset release</pre>
</body>
</html>
)";

constexpr std::array<PageFile, 1> kFiles{{{"/", "text/html; charset=utf-8", kText}}};

}  // namespace

std::span<const PageFile> page_files() {
  return kFiles;
}

}  // namespace palpate::viewer

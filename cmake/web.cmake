# The libraries of a build for browsers, under the names that find_package() gives them elsewhere. Headers come from this
# machine, sources from the folder PALPATE_WEB_LIBRARIES (scripts/emscripten.sh). Threads there are none.
include_guard()

set(PALPATE_WEB_LIBRARIES "" CACHE PATH "Where sources of zlib, spng, pugixml, zstd and brotli are unpacked")

# libc++ 18 has std::stop_token for those who ask for it alone.
add_compile_definitions($<$<COMPILE_LANGUAGE:CXX>:_LIBCPP_ENABLE_EXPERIMENTAL>)

# Of /usr/include only what has no part in this machine's C library.
set(web_headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${web_headers})
function(web_headers_of name header)
  find_path(${name}_folder ${header} PATHS /usr/local/include /usr/include PATH_SUFFIXES eigen3 NO_CMAKE_FIND_ROOT_PATH
    REQUIRED)
  cmake_path(GET header PARENT_PATH folder)
  file(CREATE_LINK ${${name}_folder}/${folder} ${web_headers}/${folder} SYMBOLIC)
endfunction()
web_headers_of(Eigen Eigen/Core)
web_headers_of(fmt fmt/format.h)
web_headers_of(nlohmann nlohmann/json.hpp)

# web_headers_alone(NAME [DEFINITION...]): a library that has nothing to link.
function(web_headers_alone name)
  string(REPLACE "::" "_" target web_${name})
  add_library(${target} INTERFACE)
  target_include_directories(${target} SYSTEM INTERFACE ${web_headers})
  target_compile_definitions(${target} INTERFACE ${ARGN})
  add_library(${name} ALIAS ${target})
endfunction()
web_headers_alone(Eigen3::Eigen)
web_headers_alone(fmt::fmt FMT_HEADER_ONLY)
web_headers_alone(nlohmann_json::nlohmann_json)
web_headers_alone(TBB::tbb PALPATE_SERIAL)

# web_library(NAME FOLDER INCLUDE SOURCE...): one built from source. FOLDER may be a pattern, sources as well.
function(web_library name folder include)
  string(REPLACE "::" "_" target web_${name})
  file(GLOB root ${PALPATE_WEB_LIBRARIES}/${folder})
  list(TRANSFORM ARGN PREPEND ${root}/)
  file(GLOB sources ${ARGN})
  if(NOT sources)
    message(FATAL_ERROR "${name}: no ${folder} in \"${PALPATE_WEB_LIBRARIES}\"; scripts/tab.sh brings it")
  endif()
  add_library(${target} STATIC ${sources})
  target_include_directories(${target} SYSTEM PUBLIC ${root}/${include})
  target_compile_options(${target} PRIVATE -w)
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  add_library(${name} ALIAS ${target})
endfunction()
web_library(ZLIB::ZLIB zlib-* . adler32.c compress.c crc32.c deflate.c infback.c inffast.c inflate.c inftrees.c trees.c
  uncompr.c zutil.c)
web_library(PkgConfig::spng libspng-* spng spng/spng.c)
target_compile_definitions(web_PkgConfig_spng PUBLIC SPNG_STATIC)
target_link_libraries(web_PkgConfig_spng PRIVATE ZLIB::ZLIB)
web_library(PkgConfig::pugixml pugixml-* src src/pugixml.cpp)
web_library(PkgConfig::zstd zstd-* lib lib/common/*.c lib/decompress/*.c)
target_compile_definitions(web_PkgConfig_zstd PRIVATE ZSTD_DISABLE_ASM)
web_library(PkgConfig::brotlidec google-brotli-* c/include c/common/*.c c/dec/*.c)

# The libraries that palpate is made with.
include_guard()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(ZLIB REQUIRED)
if(PALPATE_CORE_ONLY)
  return()
endif()
find_package(PkgConfig REQUIRED)
# Header-only and inside alone: who links palpate::core needs no JSON library.
find_package(nlohmann_json REQUIRED)
pkg_check_modules(spng REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(pugixml REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(brotlidec REQUIRED IMPORTED_TARGET libbrotlidec)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)

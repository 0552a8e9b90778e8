# GTest::gmock for programs of Node, from the sources that Debian packages; without them there is no such target.
set(sources /usr/src/googletest)
if(NOT EXISTS ${sources}/googlemock/src/gmock-all.cc)
  message(STATUS "tests: ${sources} (Debian: googletest) is absent: only the module of a tab is tested")
  return()
endif()
add_library(web_gmock STATIC ${sources}/googletest/src/gtest-all.cc ${sources}/googlemock/src/gmock-all.cc)
target_include_directories(web_gmock PRIVATE ${sources}/googletest ${sources}/googlemock)
target_include_directories(web_gmock SYSTEM PUBLIC ${sources}/googletest/include ${sources}/googlemock/include)
target_compile_features(web_gmock PUBLIC cxx_std_20)
target_compile_options(web_gmock PRIVATE -w -O1)
target_link_options(web_gmock INTERFACE -O1 -sNODERAWFS -sENVIRONMENT=node -sEXIT_RUNTIME -sALLOW_MEMORY_GROWTH
  -sMAXIMUM_MEMORY=4GB -sSTACK_SIZE=1MB -sINITIAL_MEMORY=64MB --pre-js ${CMAKE_CURRENT_LIST_DIR}/environment.js)
add_library(GTest::gmock ALIAS web_gmock)

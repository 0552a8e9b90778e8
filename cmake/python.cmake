# The Python module: which Python it is for, and whether all that it needs is there. PALPATE_PYTHON names the
# program; unset, it is the first python3 that has NumPy, and where anything is absent palpate is built without.
set(PALPATE_PYTHON "" CACHE FILEPATH "Python that the module is for; empty: the first that has NumPy")

# Sets `result` to the first python3, of PATH or the system's, that can import numpy.
function(palpate_find_python result)
  find_program(on_path python3 NO_CACHE)
  foreach(program ${on_path} /usr/bin/python3)
    execute_process(COMMAND ${program} -c "import numpy" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(NOT failed)
      set(${result} ${program} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

if(PALPATE_PYTHON)
  set(Python_EXECUTABLE ${PALPATE_PYTHON})
  set(needed REQUIRED)
else()
  palpate_find_python(Python_EXECUTABLE)
  set(needed QUIET)
endif()
set(found ${Python_EXECUTABLE})
set(PYBIND11_NOPYTHON ON)  # which Python it is, is said here
find_package(Python 3.9 COMPONENTS Interpreter Development.Module ${needed})
find_package(pybind11 2.10 ${needed})
if(NOT found OR NOT Python_Development.Module_FOUND OR NOT pybind11_FOUND)
  message(STATUS "python: pybind11-dev, python3-dev or python3-numpy is absent; built without a Python module")
  set(PALPATE_BUILD_PYTHON OFF)
elseif(PALPATE_SANITIZED AND NOT (CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "=address"))
  set(PALPATE_BUILD_PYTHON OFF)  # Python itself is not instrumented, so it has to load the sanitizer as a library
elseif(PALPATE_SANITIZED)
  foreach(library asan stdc++)  # the sanitizer looks at exceptions from its start on, and Python has none
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${library}.so
      OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(APPEND PALPATE_PRELOADED ${path}:)
  endforeach()
endif()

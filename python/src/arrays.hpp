#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "gil.hpp"

namespace palpate::python {

namespace py = pybind11;

/// A type of numbers, as numpy calls it.
struct NumberType {
  char kind = 'f';  ///< f: real, u: unsigned
  int bytes = 8;
  const char* name = "float64";
};

inline constexpr NumberType kFloat64{'f', 8, "float64"};
inline constexpr NumberType kFloat32{'f', 4, "float32"};
inline constexpr NumberType kUint16{'u', 2, "uint16"};
inline constexpr NumberType kUint8{'u', 1, "uint8"};

/// An array of this shape (-1: any length) as one of `types`, row by row in memory: `given` itself
/// if it is that, else a copy of its numbers. `what` names it in messages. Its data stay alive with
/// the result.
/// @throws py::type_error that names the cast or the shape.
[[nodiscard]] py::array readable(const py::object& given, const std::string& what,
                                 std::initializer_list<NumberType> types,
                                 const std::vector<py::ssize_t>& shape);

/// (n, 3) coordinates, read where they are if they fit; of structured arrays, as ROS's and
/// RealSense's modules give them, the fields x, y, z or f0, f1, f2. Reading needs no GIL.
class Vectors {
 public:
  /// @throws py::type_error as readable() does.
  Vectors(const py::object& given, const std::string& what);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool is_float32() const noexcept { return narrow_ != nullptr; }
  /// All of them where is_float32().
  [[nodiscard]] std::span<const Eigen::Vector3f> floats() const noexcept;
  [[nodiscard]] Eigen::Vector3d operator[](std::size_t i) const noexcept {
    if (narrow_ != nullptr)
      return Eigen::Map<const Eigen::Vector3f>(narrow_ + 3 * i).cast<double>();
    return Eigen::Map<const Eigen::Vector3d>(wide_ + 3 * i);
  }

 private:
  py::array array_;
  const float* narrow_ = nullptr;
  const double* wide_ = nullptr;
  std::size_t size_ = 0;
};

/// Memory that `owner` holds, as an array that cannot be written to.
template <class Number>
[[nodiscard]] py::array view_of(const Number* data, std::vector<py::ssize_t> shape,
                                const py::handle& owner) {
  py::array_t<Number> view(std::move(shape), data, owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

/// Columns of vectors of three, as (n, 3).
[[nodiscard]] py::array view_of(std::span<const Eigen::Vector3f> column, const py::handle& owner);

/// Lets other threads of Python go on and, after that, takes the mutexes: nobody waits for one with
/// the GIL.
template <class... Mutexes>
class Away {
 public:
  explicit Away(Mutexes&... mutexes) : locks_(mutexes...) {}

 private:
  Released release_;
  std::scoped_lock<Mutexes...> locks_;
};

/// A rigid motion of a (4, 4) matrix, or of the first three rows of one. @throws Error when it is
/// none.
[[nodiscard]] Eigen::Isometry3d pose_of(const Eigen::MatrixXd& matrix);

}  // namespace palpate::python

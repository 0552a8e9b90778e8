// Checks numpy arrays and reads them, where they are if they fit.
#include "arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "geometry/rotation.hpp"
#include "palpate/base/error.hpp"

namespace palpate::python {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& is, const std::string& cast) {
  throw py::type_error(fmt::format("{} {}; give {}", what, is, cast));
}

std::string words(const py::handle& object) {
  return py::str(object).cast<std::string>();
}

bool fits(const py::array& array, const std::vector<py::ssize_t>& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i] >= 0 && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
  }
  return true;
}

std::string in_words(const std::vector<py::ssize_t>& shape) {
  std::string sizes = fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  if (const auto any = sizes.find("-1"); any != std::string::npos) sizes.replace(any, 2, "n");
  return sizes;
}

// Real numbers of another size are taken as real ones. Whole ones are, too, where no type is whole:
// elsewhere they count units, and only what holds all of them will do.
const NumberType* type_for(const py::dtype& given, std::initializer_list<NumberType> types) {
  const auto same = [&](const NumberType& each) {
    return each.kind == given.kind() && each.bytes == given.itemsize();
  };
  const auto holds = [&](const NumberType& each) {
    if (each.kind != 'f') return each.kind == given.kind() && each.bytes >= given.itemsize();
    const bool whole = given.kind() == 'i' || given.kind() == 'u';
    return given.kind() == 'f' || (whole && types.begin()->kind == 'f');
  };
  const auto* found = std::ranges::find_if(types, same);
  if (found == types.end()) found = std::ranges::find_if(types, holds);
  return found == types.end() ? nullptr : found;
}

// How rows of `wide` numbers are made of `array`: they lie along its last axis, or along the only
// other one of so many, or are the first ones of the last. Empty: nothing tells where they are.
std::string rows_of(const std::string& what, const py::array& array, py::ssize_t wide) {
  constexpr py::ssize_t kPoint = 9;  // numbers of a point with a normal and a colour
  const std::vector<py::ssize_t> sizes(array.shape(), array.shape() + array.ndim());
  if (sizes.size() < 2) {
    return array.size() % wide == 0 ? fmt::format("{}.reshape(-1, {})", what, wide) : "";
  }
  const bool flat = sizes.size() == 2;
  const py::ssize_t last = sizes.back();
  if (last == wide) return fmt::format("{}.reshape(-1, {})", what, wide);
  const auto axis = std::ranges::find(sizes, wide);
  const bool only = std::ranges::count(sizes, wide) == 1;
  if (flat && only) return what + ".T";
  if (only) {
    return fmt::format("np.moveaxis({}, {}, -1).reshape(-1, {})", what, axis - sizes.begin(), wide);
  }
  if (last <= wide || last > kPoint) return {};
  return flat ? fmt::format("{}[:, :{}]", what, wide)
              : fmt::format("{}.reshape(-1, {})[:, :{}]", what, last, wide);
}

// An example of how `array` gets the shape that is wanted; empty: there is none.
std::string reshaped(const std::string& what, const py::array& array,
                     const std::vector<py::ssize_t>& shape) {
  if (shape.size() == 2 && shape[0] < 0) return rows_of(what, array, shape[1]);
  if (shape.size() == 2 && array.ndim() == 2 && array.shape(0) == shape[1] &&
      array.shape(1) == shape[0]) {
    return what + ".T";
  }
  const bool any = std::ranges::count(shape, -1) > 0;
  const auto size = std::accumulate(shape.begin(), shape.end(), py::ssize_t{1}, std::multiplies());
  if (!any && size != array.size()) return {};
  return fmt::format("{}.reshape({})", what, fmt::join(shape, ", "));
}

// The columns of points with named coordinates; anything else as it is.
py::object coordinates(const py::object& given) {
  if (!py::isinstance<py::array>(given) || py::hasattr(given, "mask")) return given;
  const py::object names = given.attr("dtype").attr("names");
  if (names.is_none()) return given;
  for (const auto& triple : {std::array{"x", "y", "z"}, std::array{"f0", "f1", "f2"}}) {
    const auto there = [&](const char* name) { return names.contains(name); };
    if (!std::ranges::all_of(triple, there)) continue;
    py::list columns;
    for (const char* name : triple) columns.append(given[name].attr("ravel")());
    return py::module_::import("numpy").attr("stack")(columns, py::arg("axis") = 1);
  }
  return given;
}

}  // namespace

py::array readable(const py::object& given, const std::string& what,
                   std::initializer_list<NumberType> types, const std::vector<py::ssize_t>& shape) {
  const std::string first = types.begin()->name;
  if (!py::isinstance<py::array>(given)) {
    refuse(what, fmt::format("is a {}", words(py::type::of(given).attr("__name__"))),
           fmt::format("np.asarray({}, dtype=np.{})", what, first));
  }
  const auto array = py::reinterpret_borrow<py::array>(given);
  const NumberType* const type = type_for(array.dtype(), types);
  if (type == nullptr && !array.dtype().attr("names").is_none()) {
    const bool all = shape.size() == 2 &&
                     py::len(array.dtype().attr("names")) == static_cast<std::size_t>(shape[1]);
    refuse(what, fmt::format("has the fields {}", words(array.dtype().attr("names"))),
           fmt::format("numpy.lib.recfunctions.structured_to_unstructured({}{}", what,
                       all ? ")" : "[[...]]) with the names of those that it is made of"));
  }
  if (type == nullptr) {
    refuse(what, fmt::format("holds {}", words(array.dtype())),
           fmt::format("{}.astype(np.{})", what, first));
  }
  if (py::hasattr(array, "mask")) {
    const bool rows = shape.front() < 0;
    refuse(what, "is a masked array, whose mask would not be read",
           fmt::format(fmt::runtime(rows ? "np.ma.compress_rows({})" : "{}.filled(0)"), what));
  }
  if (!fits(array, shape)) {
    const std::string example = reshaped(what, array, shape);
    refuse(
        what, fmt::format("has shape {}", words(array.attr("shape"))),
        fmt::format("shape {}{}{}", in_words(shape), example.empty() ? "" : ", such as ", example));
  }
  return py::module_::import("numpy").attr("require")(array, type->name,
                                                      py::make_tuple("C", "ALIGNED"));
}

Vectors::Vectors(const py::object& given, const std::string& what)
    : array_(readable(coordinates(given), what, {kFloat64, kFloat32}, {-1, 3})),
      size_(static_cast<std::size_t>(array_.shape(0))) {
  if (array_.itemsize() == kFloat32.bytes) {
    narrow_ = static_cast<const float*>(array_.data());
  } else {
    wide_ = static_cast<const double*>(array_.data());
  }
}

std::span<const Eigen::Vector3f> Vectors::floats() const noexcept {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  return {reinterpret_cast<const Eigen::Vector3f*>(narrow_), size_};
}

py::array view_of(std::span<const Eigen::Vector3f> column, const py::handle& owner) {
  const float* const data = column.empty() ? nullptr : column.front().data();
  return view_of(data, {static_cast<py::ssize_t>(column.size()), 3}, owner);
}

Eigen::Isometry3d pose_of(const Eigen::MatrixXd& matrix) {
  if (matrix.cols() != 4 || (matrix.rows() != 4 && matrix.rows() != 3)) {
    throw Error(fmt::format(
        "a pose has shape ({}, {}); give a (4, 4) matrix from sensor to world, or its first three "
        "rows",
        matrix.rows(), matrix.cols()));
  }
  if (matrix.rows() == 4 && matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw Error("a pose's last row is not 0, 0, 0, 1; give a (4, 4) matrix from sensor to world");
  }
  if (!is_rotation(matrix.topLeftCorner<3, 3>())) {
    throw Error(
        "a pose is not finite, scales, shears or mirrors; give a rotation and a shift, and scale "
        "the data");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.affine() = matrix.topRows<3>();
  return pose;
}

}  // namespace palpate::python

// Checks and reads numpy arrays without copying.
#include "arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "palpate/base/error.hpp"

namespace palpate::python {
namespace {

constexpr int kAligned = py::detail::npy_api::NPY_ARRAY_ALIGNED_;

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

}  // namespace

py::array readable(const py::object& given, const std::string& what,
                   std::initializer_list<NumberType> types, const std::vector<py::ssize_t>& shape) {
  const std::string first = types.begin()->name;
  if (!py::isinstance<py::array>(given)) {
    refuse(what, fmt::format("is a {}", words(py::type::of(given).attr("__name__"))),
           fmt::format("np.asarray({}, dtype=np.{})", what, first));
  }
  auto array = py::reinterpret_borrow<py::array>(given);
  const py::dtype type = array.dtype();
  const auto* const found = std::ranges::find_if(types, [&](const NumberType& each) {
    return each.kind == type.kind() && each.bytes == type.itemsize();
  });
  const bool native = type.attr("isnative").cast<bool>();
  if (found == types.end() || !native) {
    const std::string name = found == types.end() ? first : found->name;
    refuse(what, fmt::format("holds {}", native ? words(type) : "another byte order"),
           fmt::format("{}.astype(np.{})", what, name));
  }
  if (!fits(array, shape)) {
    const bool turned = shape.size() == 2 && array.ndim() == 2 && array.shape(0) == shape[1];
    const std::string remedy =
        turned ? what + ".T.copy()" : fmt::format("{}.reshape({})", what, fmt::join(shape, ", "));
    refuse(what, fmt::format("has shape {}", words(array.attr("shape"))),
           fmt::format("shape {}, such as {}", in_words(shape), remedy));
  }
  if ((array.flags() & py::array::c_style) == 0 || (array.flags() & kAligned) == 0) {
    refuse(what, "does not lie row by row in memory", what + ".copy()");
  }
  return array;
}

Vectors::Vectors(const py::object& given, const std::string& what)
    : array_(readable(given, what, {kFloat64, kFloat32}, {-1, 3})),
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

Eigen::Isometry3d pose_of(const Eigen::Matrix4d& matrix) {
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw Error("a pose's last row is not 0, 0, 0, 1; give a (4, 4) matrix from sensor to world");
  }
  Eigen::Isometry3d pose;
  pose.matrix() = matrix;
  return pose;
}

}  // namespace palpate::python

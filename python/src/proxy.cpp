// Binds the proxy, contacts and rollouts.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "module.hpp"
#include "options.hpp"
#include "rollout.hpp"

namespace palpate::python {
namespace {

std::unique_ptr<TimedProxy> new_proxy(const py::kwargs& given) {
  Keywords keywords(given, "Proxy");
  ProxyOptions options;
  take(keywords, options);
  keywords.finish();
  return std::make_unique<TimedProxy>(options);
}

Contact step(TimedProxy& proxy, AnyField& field, const Eigen::Vector3d& hip, double dt) {
  const Away away(field.mutex, proxy.mutex);
  return proxy.step(field, hip, proxy.time, dt);
}

std::string words(const Contact& contact) {
  if (!contact.touching) return "<palpate.Contact: touches nothing>";
  return fmt::format("<palpate.Contact: {:.4g} N>", contact.force.norm());
}

// Every note of contacts, by name.
std::vector<std::string> names(std::uint32_t notes) {
  using enum ContactNote;
  constexpr std::pair<ContactNote, const char*> kNotes[] = {{sweep_truncated, "sweep_truncated"},
                                                            {lost, "lost"},
                                                            {not_converged, "not_converged"},
                                                            {reanchored, "reanchored"},
                                                            {fault, "fault"},
                                                            {softer, "softer"},
                                                            {fell, "fell"},
                                                            {freed, "freed"},
                                                            {inside, "inside"}};
  std::vector<std::string> found;
  for (const auto& [note, name] : kNotes) {
    if (has(static_cast<ContactNote>(notes), note)) found.emplace_back(name);
  }
  return found;
}

std::string words(const Rollout& out) {
  const auto ticks = static_cast<std::size_t>(out.time.size());
  std::size_t touching = 0;
  std::uint32_t notes = 0;
  double largest = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    touching += out.touching.data()[i] ? 1 : 0;
    notes |= out.notes.data()[i];
    largest = std::max(largest, Eigen::Map<const Eigen::Vector3d>(out.force.data() + 3 * i).norm());
  }
  const std::vector<std::string> noted = names(notes);
  return fmt::format("<palpate.Rollout: {} ticks, {} in contact, largest force {:.4g} N{}{}>",
                     ticks, touching, largest,
                     noted.empty() ? "" : "; notes: ", fmt::join(noted, ", "));
}

py::dict columns(const Rollout& out) {
  using py::literals::operator""_a;
  return py::dict("time"_a = out.time, "hip"_a = out.hip, "force"_a = out.force,
                  "proxy"_a = out.proxy, "normal"_a = out.normal, "stiffness"_a = out.stiffness,
                  "touching"_a = out.touching, "sliding"_a = out.sliding, "source"_a = out.source,
                  "iterations"_a = out.iterations, "evaluations"_a = out.evaluations,
                  "notes"_a = out.notes, "field_notes"_a = out.field_notes);
}

void define_results(py::module_& module) {
  py::class_<Contact>(module, "Contact", "What one tick gave; world frame")
      .def("__repr__", [](const Contact& contact) { return words(contact); })
      .def_readonly("force", &Contact::force, "(3,) on the hand, N")
      .def_readonly("proxy", &Contact::proxy, "(3,) m")
      .def_readonly("normal", &Contact::normal, "(3,) outward, unit; zero: touches nothing")
      .def_readonly("drift", &Contact::drift, "(3,) velocity of the touched surface, m/s")
      .def_readonly("stiffness", &Contact::stiffness, "N/m")
      .def_readonly("touching", &Contact::touching)
      .def_readonly("sliding", &Contact::sliding)
      .def_readonly("source", &Contact::source, "index of the touched source; -1: none")
      .def_property_readonly(
          "notes", [](const Contact& contact) { return static_cast<std::uint32_t>(contact.notes); },
          "bits; note_names() names them");
  py::class_<Rollout>(module, "Rollout", "What the n ticks of a hand gave; world frame")
      .def("__len__", [](const Rollout& out) { return out.time.size(); })
      .def("__repr__", [](const Rollout& out) { return words(out); })
      .def("columns", &columns, "All arrays by name: np.savez(file, **out.columns())")
      .def_readonly("time", &Rollout::time, "(n,) s")
      .def_readonly("hip", &Rollout::hip, "(n, 3) the hand, m")
      .def_readonly("force", &Rollout::force, "(n, 3) on the hand, N")
      .def_readonly("proxy", &Rollout::proxy, "(n, 3) m; on the surface in contact")
      .def_readonly("normal", &Rollout::normal, "(n, 3) outward, unit; zero: touches nothing")
      .def_readonly("stiffness", &Rollout::stiffness, "(n,) N/m")
      .def_readonly("touching", &Rollout::touching, "(n,) bool")
      .def_readonly("sliding", &Rollout::sliding, "(n,) bool: friction gave way")
      .def_readonly("source", &Rollout::source, "(n,) int32, index; -1: none")
      .def_readonly("iterations", &Rollout::iterations, "(n,) int32")
      .def_readonly("evaluations", &Rollout::evaluations, "(n,) int32, of the field")
      .def_readonly("notes", &Rollout::notes, "(n,) uint32, bits; note_names() names them")
      .def_readonly("field_notes", &Rollout::field_notes,
                    "(n,) uint32, bits of FieldNote; 0 for formulas");
}

constexpr const char* kProxy = R"(The point that follows the hand and stays on the surface.

Keywords: {}. Input that is not finite is a fault: zero force until reset().)";

constexpr const char* kRollout = R"(All ticks of a hand, without the GIL.

hand: (n, 3), m, world; float64 or float32 row by row is read where it is. dt: s between ticks. time: (n,), s, of
each tick; None: from proxy.time on. The proxy goes on from where it is.)";

std::string words(const TimedProxy& proxy) {
  return fmt::format("<palpate.Proxy: {} N/m>", proxy.proxy.options().stiffness);
}

}  // namespace

void define_proxy(py::module_& module) {
  using py::arg;
  using Bound = TimedProxy;
  using Free = py::call_guard<Released>;
  define_results(module);
  py::class_<Bound>(module, "Proxy",
                    fmt::format(kProxy, listed(keywords_of<ProxyOptions>())).c_str())
      .def(py::init(&new_proxy))
      .def("__repr__", [](const Bound& proxy) { return words(proxy); })
      .def("step", &step, arg("field"), arg("hip"), arg("dt") = 1e-3,
           "One tick: hip (3,), m, world; dt s. rollout() does many at once")
      .def("reset", &Bound::reset, Free(), arg("position"),
           "Puts it at (3,), m, in free space; forgets contact and faults")
      .def_property_readonly("position", py::cpp_function(&Bound::position, Free()), "(3,) m")
      .def_property_readonly("time", py::cpp_function(&Bound::next_time, Free()),
                             "of the next tick, s: what the stamps of push() are compared with");
  module.def("rollout", &rollout, arg("field"), arg("proxy"), arg("hand"), arg("dt") = 1e-3,
             py::kw_only(), arg("time") = py::none(), kRollout);
  module.def("note_names", &names, arg("notes"), "Names of the bits in Rollout.notes");
}

}  // namespace palpate::python

// Encodes clouds, surfaces around tools and reports for the pages.
#include "viewer/scene_encoder.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/scene/scene_field.hpp"
#include "viewer/messages.hpp"
#include "viewer/reports.hpp"

namespace palpate::viewer {

namespace {

// A proxy that moved by less shows nothing new, in R.
constexpr double kWorthIt = 0.1;

// Between the support at which capped solids end behind their surface and that of the surface
// itself.
double least_support_of(const FieldOptions& options) {
  const bool ends =
      options.capped && options.kind != FieldOptions::Kind::metaball && !options.raw_weights;
  return ends ? 0.5 * (options.minimum_support + options.threshold) : 0;
}

constexpr double kPeriod = 0.1;         // s between pictures (judgement)
constexpr double kSourcesPeriod = 0.5;  // s between reports of the sources (judgement)
constexpr double kRest = 3;  // times the last picture's computing time, as a pause (judgement)

}  // namespace

// Meshes the surface around a servo's proxy, by a field of its own. One thread uses it, and not the
// servo's.
class SurfaceEncoder {
 public:
  // @throws Error when the scene has no slot for one more field.
  SurfaceEncoder(Scene& scene, const Servo& servo, std::size_t device,
                 const Eigen::Vector3d& origin)
      : servo_(servo),
        device_(static_cast<std::uint8_t>(device)),
        origin_(origin),
        options_(servo.field()),
        field_(scene, options_, "the viewer") {}

  [[nodiscard]] EncodedSurface encode() {
    const ServoState state = servo_.state();
    if (state.step == 0) return {};
    const Eigen::Vector3d& proxy = state.contact.proxy;
    follow_options();
    field_.end_step(proxy, state.contact.normal);  // it is seen from where the servo's proxy is
    field_.update_from(state.time, state.hip, proxy);
    const double radius = field_.sample(proxy).radius;
    if (!is_new(proxy, radius)) return {radius, newest_};
    const Mesh mesh = local_surface(field_, {proxy, radius, least_support_of(options_)});
    const Eigen::Vector3f center = (proxy - origin_).cast<float>();
    // An empty one takes away what a page had before.
    newest_ = std::make_shared<const std::string>(encode_surface(device_, center, mesh));
    return {radius, newest_};
  }

 private:
  void follow_options() {
    const FieldOptions options = servo_.field();
    if (options == options_) return;
    options_ = options;
    field_.change(options_);
    encoded_ = false;
  }

  bool is_new(const Eigen::Vector3d& proxy, double radius) {
    const std::uint64_t revision = field_.traits().revision;
    const bool same = encoded_ && revision == encoded_revision_ &&
                      (proxy - encoded_at_).norm() < kWorthIt * radius;
    if (same) return false;
    encoded_ = true;
    encoded_revision_ = revision;
    encoded_at_ = proxy;
    return true;
  }

  const Servo& servo_;
  std::uint8_t device_;
  Eigen::Vector3d origin_;
  FieldOptions options_;  // of the field
  SceneField field_;
  Eigen::Vector3d encoded_at_ = Eigen::Vector3d::Zero();
  std::uint64_t encoded_revision_ = 0;
  bool encoded_ = false;
  SharedBytes newest_;
};

SceneEncoder::SceneEncoder(Scene& scene, SceneEncoderOptions options)
    : scene_(scene), options_(std::move(options)), clouds_(scene, options_.origin) {}

SceneEncoder::~SceneEncoder() = default;

void SceneEncoder::rest() {
  surfaces_.clear();
}

double SceneEncoder::pause_after(double took) noexcept {
  return std::max(kPeriod - took, kRest * took);
}

EncodedScene SceneEncoder::encode(const std::set<std::size_t>& budgets, double now) {
  EncodedScene encoded;
  try {
    encode(budgets, now, encoded);
  } catch (const std::exception& error) {
    encoded = {};
    encoded.complaint = news(error.what());
  }
  return encoded;
}

void SceneEncoder::encode(const std::set<std::size_t>& budgets, double now, EncodedScene& encoded) {
  std::set<std::size_t> drawn = budgets;
  drawn.erase(0);
  encoded.clouds = clouds_.encode(drawn, surface_time());
  drawn.empty() ? surfaces_.clear() : encode_surfaces(encoded);
  if (now - reported_ < kSourcesPeriod) return;
  reported_ = now;
  report(encoded);
}

// A scene that has no slot for one more field is seen all the same.
void SceneEncoder::encode_surfaces(EncodedScene& encoded) {
  std::string complaint;
  try {
    join_scene();
  } catch (const Error& error) {
    complaint = error.what();
  }
  encoded.complaint = news(std::move(complaint));
  for (const auto& surface : surfaces_) encoded.surfaces.push_back(surface->encode());
}

void SceneEncoder::join_scene() {
  for (std::size_t i = surfaces_.size(); i < options_.servos.size(); ++i) {
    surfaces_.push_back(
        std::make_unique<SurfaceEncoder>(scene_, *options_.servos[i], i, options_.origin));
  }
}

void SceneEncoder::report(EncodedScene& encoded) {
  const std::vector<ViewedStream> streams =
      options_.streams ? options_.streams() : std::vector<ViewedStream>{};
  const std::string robot = options_.robot ? options_.robot() : "";
  encoded.sources = std::make_shared<const std::string>(
      sources_text(source_reports(scene_, streams, options_.origin, surface_time()),
                   robot));  // painting took time
}

std::string SceneEncoder::news(std::string complaint) {
  if (complaint_ == complaint) return {};
  complaint_ = std::move(complaint);
  return complaint_;
}

// The servos' clock is the snapshots'.
double SceneEncoder::surface_time() const {
  double time = 0;
  for (const Servo* servo : options_.servos) time = std::max(time, servo->state().time);
  return time;
}

}  // namespace palpate::viewer

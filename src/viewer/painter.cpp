#include "viewer/painter.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "viewer/source_reports.hpp"

namespace palpate::viewer {
namespace {

constexpr double kPeriod = 0.1;         // s between pictures
constexpr double kSourcesPeriod = 0.5;  // s between reports of the sources
constexpr double kRest = 3;             // times what the last picture took

double host_time() {
  return SteadyClock().now();
}

}  // namespace

Painter::Painter(Scene& scene, PainterOptions options)
    : scene_(scene),
      options_(std::move(options)),
      clouds_(scene, options_.origin),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void Painter::look(std::set<std::size_t> budgets) {
  {
    const std::lock_guard lock(mutex_);
    if (budgets == budgets_) return;
    budgets_ = std::move(budgets);
  }
  changed_.notify_one();
}

void Painter::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::set<std::size_t> budgets;
    {
      std::unique_lock lock(mutex_);
      if (budgets_.empty()) {
        lock.unlock();
        surfaces_.clear();
        lock.lock();
        changed_.wait(lock, stop, [this] { return !budgets_.empty(); });
      }
      budgets = budgets_;
    }
    if (!budgets.empty()) work(stop, budgets);
  }
}

void Painter::work(const std::stop_token& stop, const std::set<std::size_t>& budgets) {
  const double begin = host_time();
  try {
    options_.show(paint(budgets));
  } catch (const std::exception& error) {
    Picture picture;
    picture.complaint = news(error.what());
    options_.show(std::move(picture));
  }
  const double took = host_time() - begin;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop,
                    std::chrono::duration<double>(std::max(kPeriod - took, kRest * took)),
                    [&] { return budgets_ != budgets; });
}

Picture Painter::paint(const std::set<std::size_t>& budgets) {
  Picture picture;
  std::set<std::size_t> drawn = budgets;
  drawn.erase(0);
  picture.clouds = clouds_.paint(drawn, now());
  drawn.empty() ? surfaces_.clear() : paint_surfaces(picture);
  if (host_time() - reported_ >= kSourcesPeriod) report(picture);
  return picture;
}

// A scene that has no place for one more field is seen all the same.
void Painter::paint_surfaces(Picture& picture) {
  std::string complaint;
  try {
    join_scene();
  } catch (const Error& error) {
    complaint = error.what();
  }
  picture.complaint = news(std::move(complaint));
  for (const auto& surface : surfaces_) picture.surfaces.push_back(surface->paint());
}

void Painter::join_scene() {
  for (std::size_t i = surfaces_.size(); i < options_.servos.size(); ++i) {
    surfaces_.push_back(
        std::make_unique<SurfacePainter>(scene_, *options_.servos[i], i, options_.origin));
  }
}

void Painter::report(Picture& picture) {
  reported_ = host_time();
  const std::vector<ViewerStream> streams =
      options_.streams ? options_.streams() : std::vector<ViewerStream>{};
  picture.sources = std::make_shared<const std::string>(
      sources_text(source_reports(scene_, streams, options_.origin, now())));  // painting took time
}

std::string Painter::news(std::string complaint) {
  if (told_ == complaint) return {};
  told_ = std::move(complaint);
  return told_;
}

// The servos' clock is the snapshots'.
double Painter::now() const {
  double time = 0;
  for (const Servo* servo : options_.servos) time = std::max(time, servo->state().time);
  return time;
}

}  // namespace palpate::viewer

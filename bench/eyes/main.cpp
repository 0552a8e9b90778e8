// Measures what hands before, beside and behind the scenes of one or two depth cameras feel.
#include "common/main.hpp"

#include <array>

#include "eyes/view.hpp"

namespace palpate::eyes {
namespace {

constexpr std::uint64_t kKinds = 1000;  // seeds of kinds are apart

struct Options {
  bench::SeedOptions seeds;
  std::vector<std::string> noises = {"a", "b", "c", "waves"};
  std::vector<std::string> feeds = {"still"};
  int hands = 14;  // of a scene; a scene has 16 readers
};

Feed feed_of(const std::string& name) {
  const std::array<std::string, 6> names = {"still",  "moving",    "single",
                                            "points", "viewpoint", "opposed"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == name) return static_cast<Feed>(k);
  }
  throw Error("there is no feed '" + name +
              "'; still, moving, single, points, viewpoint and opposed are");
}

Score play_scene(const Kind& kind, std::uint64_t seed, const std::string& noise, Feed feed,
                 const Options& options) {
  constexpr std::array<const char*, 4> kHands = {"slide", "poke", "aside", "behind"};
  constexpr std::array<const char*, 4> kThrough = {"through", "through", "slide", "through"};
  View view(seed * kKinds + static_cast<std::uint64_t>(&kind - kinds().data()));
  kind.draw(view);
  if (feed == Feed::opposed) view.oppose();
  set_noise(noise, view);
  view.feed = feed;
  if (feed == Feed::still || feed == Feed::opposed) {
    for (SimulatedCameraOptions& camera : view.cameras) camera.loop = 24;
  }
  if (feed == Feed::moving) {
    view.cameras.front().motion = {
        .swing = Vector3d(0, 0.05, 0.02), .rock = 0.05, .frequency = 0.3};
  }
  std::vector<Picture> pictures;
  for (const SimulatedCameraOptions& camera : view.cameras) pictures.emplace_back(view, camera);
  const auto& kinds_of_hands = view.gaps.empty() ? kHands : kThrough;
  std::vector<Hand> hands;
  for (int k = 0; k < options.hands; ++k) {
    Hand hand =
        draw_hand(view, pictures[static_cast<std::size_t>(k) / kHands.size() % pictures.size()],
                  kinds_of_hands[static_cast<std::size_t>(k) % kinds_of_hands.size()]);
    if (!hand.hip.empty()) hands.push_back(std::move(hand));
  }
  const std::vector<Felt> felt = play(view, hands);
  Score all;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    const Score one = score(view, pictures, hands[k], felt[k]);
    all += one;
    if (options.seeds.each && (one.held > 0 || one.caught > 0 || one.thrown > 0)) {
      fmt::print("{} {} seed {} hand {} {}: held {} caught {} thrown {} most {:.1f} N\n", kind.name,
                 noise, seed, k, hands[k].kind, one.held, one.caught, one.thrown, one.most);
    }
  }
  return all;
}

void print_line(const std::string& name, const Score& s) {
  const auto share = [](double part, double of) { return of > 0 ? 100 * part / of : 0; };
  fmt::print("| {} | {} | {} | {:.1f} | {} of {} | {} | {} | {:.2f} % | {:.1f} % | {:.1f} |\n",
             name, s.hands, s.held, s.most, s.caught, s.hidden, s.thrown, s.steps,
             share(s.lost, s.asked), share(s.lost_in_shadow, s.asked_in_shadow),
             s.microseconds / std::max(s.hands, 1.0));
  std::fflush(stdout);
}

void run(const Options& options) {
  fmt::print(
      "| scenes | hands | held | most N | caught behind | thrown | steps | lost | in shadow | us "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& feed : options.feeds) {
    Score total;
    for (const std::string& noise : feed == "points" || feed == "viewpoint"
                                        ? std::vector<std::string>{"none"}
                                        : options.noises) {
      Score of_noise;
      for (const Kind& kind : kinds()) {
        if (!bench::is_wanted(kind.name, options.seeds.names)) continue;
        Score of_kind;
        for (int i = 0; i < options.seeds.seeds; ++i) {
          of_kind += play_scene(kind, options.seeds.first_seed + static_cast<std::uint64_t>(i),
                                noise, feed_of(feed), options);
        }
        print_line(fmt::format("{}, {}, {}", kind.name, noise, feed), of_kind);
        of_noise += of_kind;
      }
      print_line(fmt::format("**all**, {}, {}", noise, feed), of_noise);
      total += of_noise;
    }
    print_line(fmt::format("**all**, {}", feed), total);
  }
}

}  // namespace
}  // namespace palpate::eyes

int main(int argc, char** argv) {
  using namespace palpate;
  CLI::App app("Hands before, beside and behind what depth cameras see, in simulated time",
               "eyes_bench");
  eyes::Options options;
  options.seeds.seeds = 2;
  bench::add_options(app, options.seeds);
  app.add_option("--noise", options.noises, "a, b, c, waves, structured, stereo, tof")
      ->delimiter(',');
  app.add_option("--feeds", options.feeds, "still, moving, single, points, viewpoint, opposed")
      ->delimiter(',');
  app.add_option("--hands", options.hands, "Hands a scene")->check(CLI::Range(1, 15));
  return bench::run_main(app, argc, argv, [&] {
    eyes::run(options);
    return 0;
  });
}

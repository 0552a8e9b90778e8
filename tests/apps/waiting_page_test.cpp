#include <gtest/gtest.h>

#include <chrono>

#include "apps/palpate/options/touch_plan.hpp"
#include "apps/palpate/view/view.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {
namespace {

TouchPlan plan_with_page() {
  TouchPlan plan;
  plan.sources.emplace_back().argument.name = "table";
  plan.page.served = true;
  plan.page.port = 0;
  return plan;
}

TEST(WaitingPage, TheRunsOwnPageFollowsAtItsPlace) {
  const TouchPlan plan = plan_with_page();
  WaitingPage page(plan, std::chrono::milliseconds(0));
  page.watching(plan).sources.front().reading.progress(0.3);
  const PagePlan next = page.end();
  EXPECT_NE(next.port, plan.page.port);
  EXPECT_FALSE(next.token.empty());
  ViewerOptions options;
  options.listening = next.listening;
  Scene scene;
  EXPECT_EQ(Viewer(scene, {}, options).port(), next.port) << "it goes on at the same port";
}

TEST(WaitingPage, WhatIsReadAtOnceHasNone) {
  const TouchPlan plan = plan_with_page();
  WaitingPage page(plan, std::chrono::hours(1));
  page.watching(plan).sources.front().reading.progress(0.3);
  EXPECT_EQ(page.end().port, plan.page.port);
}

}  // namespace
}  // namespace palpate::app

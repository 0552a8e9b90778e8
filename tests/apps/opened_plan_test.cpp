// What follows where a page gives a run another file.
#include <gtest/gtest.h>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/touch_plan.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"

namespace palpate::app {
namespace {

TEST(OpenedPlan, ARunThatOthersHangOnOpensNothing) {
  const Shell shell;
  const std::string sphere = "synthetic:sphere ";
  EXPECT_TRUE(can_open_files(planned(sphere + "--view")));
  EXPECT_TRUE(can_open_files(planned("camera:simulated --view --device simulated")));
  EXPECT_FALSE(can_open_files(planned(sphere))) << "no page";
  EXPECT_FALSE(can_open_files(planned(sphere + "--view --device remote")));
  for (const char* file : {"--log", "--json", "--record"}) {
    EXPECT_FALSE(can_open_files(planned(sphere + "--view " + file + " " + shell.path("x"))));
  }
}

TEST(OpenedPlan, TheSurfaceStaysAndWhatBelongedToTheSourcesGoes) {
  const Shell shell;
  shell.write("a=b.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const TouchPlan plan = plan_of_file(
      planned("left=camera:simulated right=synthetic:sphere --pose right=1,0,0,0,0,0,1 --view "
              "--friction-dynamic 0.4"),
      shell.path("a=b.xyz"));
  ASSERT_EQ(plan.sources.size(), 1U);
  EXPECT_EQ(plan.sources[0].argument.path, shell.path("a=b.xyz"));
  EXPECT_EQ(plan.sources[0].kind, SourceKind::cloud);
  EXPECT_TRUE(plan.sources[0].options.T_world_sensor.isApprox(Eigen::Isometry3d::Identity(), 0));
  EXPECT_EQ(plan.surface.proxy.friction.dynamic_coefficient, 0.4);
  EXPECT_TRUE(plan.page.wanted);
}

TEST(OpenedPlan, AFileIsReadAndPreparedAsTheOnlySourceWas) {
  const Shell shell;
  shell.write("b.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const TouchPlan plan =
      plan_of_file(planned("synthetic:sphere --view --scale 0.001 --voxel 0.02 --viewpoint 0,0,1"),
                   shell.path("b.xyz"));
  EXPECT_EQ(plan.sources[0].reading.scale, 0.001);
  EXPECT_EQ(plan.sources[0].options.prepare.voxel, 0.02);
  EXPECT_FALSE(plan.sources[0].options.prepare.viewpoint);
  EXPECT_EQ(plan.sources[0].options.prepare.orientation, PrepareOptions().orientation);
  EXPECT_THROW((void)plan_of_file(plan, shell.path("a.oni")), UsageError);
}

TEST(OpenedPlan, AnotherUnitIsOfItsFileAndNotOfTheNext) {
  const Shell shell;
  shell.write("b.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const TouchPlan before = planned("synthetic:sphere --view --length 2 --friction-dynamic 0.4");
  const TouchPlan inches = plan_in_unit(before, 0, 0.0254);
  EXPECT_EQ(inches.sources[0].argument.path, before.sources[0].argument.path);
  EXPECT_EQ(inches.sources[0].reading.scale, 0.0254);
  EXPECT_FALSE(inches.sources[0].reading.length);
  EXPECT_EQ(inches.surface.proxy.friction.dynamic_coefficient, 0.4);
  const TouchPlan next = plan_of_file(inches, shell.path("b.xyz"));
  EXPECT_FALSE(next.sources[0].reading.scale);
}

TEST(OpenedPlan, AnExampleIsPreparedAsByDefault) {
  const TouchPlan plan = plan_of_sources(
      planned("synthetic:sphere --view --scale 0.5 --voxel 0.02"), {"desk=camera:simulated:desk"});
  ASSERT_EQ(plan.sources.size(), 1U);
  EXPECT_EQ(plan.sources[0].kind, SourceKind::stream);
  EXPECT_EQ(plan.sources[0].argument.name, "desk");
  EXPECT_FALSE(plan.sources[0].reading.scale);
  EXPECT_FALSE(plan.sources[0].options.prepare.voxel);
}

}  // namespace
}  // namespace palpate::app

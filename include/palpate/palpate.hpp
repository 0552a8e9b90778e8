#pragma once

/// What a program needs whose loop is its own. For devices: device/device.hpp and
/// servo/servo_thread.hpp.
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

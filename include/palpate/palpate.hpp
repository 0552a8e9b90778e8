#pragma once

/// Everything that most programs need.
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/io/cloud_file.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

#pragma once

// Where it was before; include the other.
#include "palpate/base/latest.hpp"

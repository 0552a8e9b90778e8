// Declares the options of the page on which a run is seen.
#pragma once

#include "apps/palpate/options/touch_plan.hpp"

namespace palpate::app {

class OptionTable;

/// Registers where the page is, and whether it opens a browser.
void add_page_options(OptionTable& table, PagePlan& page);

}  // namespace palpate::app

#pragma once

#include <cstdio>
#include <string>

#include "apps/palpate/paper/paper_fig5.hpp"
#include "apps/palpate/paper/paper_fig7.hpp"

namespace palpate::app {

/// A table for a person.
void print_figure(const Fig5& figure, const std::string& source, std::FILE* out);
void print_figure(const Fig7& figure, const std::string& source, std::FILE* out);

/// A row a size; ms.
[[nodiscard]] std::string csv(const Fig5& figure);
/// A row a servo step: t (s), then height (m), nx, ny and force (N) of each way of feeling.
[[nodiscard]] std::string csv(const Fig7& figure);

/// What figures.py is told.
[[nodiscard]] std::string facts(const Fig5& figure, const std::string& source);
[[nodiscard]] std::string facts(const Fig7& figure, const std::string& source);

}  // namespace palpate::app

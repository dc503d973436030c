// Writes docs/deck.md to the standard output: polyslip-deckref > docs/deck.md

#include <cstdio>

#include "drivers/options.hpp"

int main() {
  const std::string page = polyslip::drivers::deck_reference_page();
  return std::fputs(page.c_str(), stdout) >= 0 && std::fflush(stdout) == 0 ? 0 : 1;
}

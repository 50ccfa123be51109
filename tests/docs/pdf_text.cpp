// pdf_text <FILE.pdf: prints what tests/support/pdf_text.hpp finds in a PDF, for scripts.
#include "tests/support/pdf_text.hpp"

#include <iostream>
#include <iterator>

int main() {
  const std::string pdf{std::istreambuf_iterator<char>(std::cin), {}};
  std::cout << lrb::test::pdf_text(pdf);
}

// The bundled page inside of the program.
#include "view_site.h"

#include <cstddef>

// .incbin takes a second to assemble where an array of a million numbers takes a minute to compile.
asm(R"(
    .section .rodata
    .global dicot_page_html, dicot_page_html_end, dicot_page_csp, dicot_page_csp_end
dicot_page_html:
    .incbin ")" DICOT_PAGE_FOLDER R"(/page.html"
dicot_page_html_end:
dicot_page_csp:
    .incbin ")" DICOT_PAGE_FOLDER R"(/page.csp"
dicot_page_csp_end:
    .byte 0
    .text
)");

extern "C" const char dicot_page_html[], dicot_page_html_end[], dicot_page_csp[], dicot_page_csp_end[];

namespace dicot::app {

std::string_view view_page()
{
    return {dicot_page_html, static_cast<std::size_t>(dicot_page_html_end - dicot_page_html)};
}

std::string_view view_policy()
{
    return {dicot_page_csp, static_cast<std::size_t>(dicot_page_csp_end - dicot_page_csp)};
}

} // namespace dicot::app

// The bundled page inside of the program.
#include "view_site.h"

#include <cstddef>

// .incbin takes a second to assemble where an array of a million numbers takes a minute to compile.
asm(R"(
    .section .rodata
    .global dicot_page_html, dicot_page_html_end, dicot_server_csp, dicot_server_csp_end, dicot_files_csp, dicot_files_csp_end
dicot_page_html:
    .incbin ")" DICOT_PAGE_FOLDER R"(/page.html"
dicot_page_html_end:
dicot_server_csp:
    .incbin ")" DICOT_PAGE_FOLDER R"(/server.csp"
dicot_server_csp_end:
dicot_files_csp:
    .incbin ")" DICOT_PAGE_FOLDER R"(/files.csp"
dicot_files_csp_end:
    .byte 0
    .text
)");

extern "C" const char dicot_page_html[], dicot_page_html_end[], dicot_server_csp[], dicot_server_csp_end[],
    dicot_files_csp[], dicot_files_csp_end[];

namespace dicot::app {

std::string_view view_page()
{
    return {dicot_page_html, static_cast<std::size_t>(dicot_page_html_end - dicot_page_html)};
}

std::string_view server_policy()
{
    return {dicot_server_csp, static_cast<std::size_t>(dicot_server_csp_end - dicot_server_csp)};
}

std::string_view files_policy()
{
    return {dicot_files_csp, static_cast<std::size_t>(dicot_files_csp_end - dicot_files_csp)};
}

} // namespace dicot::app

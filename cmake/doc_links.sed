#!/bin/sed -Ef
# Doxygen 1.9 knows no anchors of headings: a link leads to the page.
s/\]\(([^)#]+)#[^)]*\)/](\1)/g
s/\[([^]]*)\]\(#[^)]*\)/\1/g

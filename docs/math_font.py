"""Makes the font of the site's formulas, docs/pages/assets/stix-two-math.woff2: STIX Two Math with what formulas need.

The whole font is four times as large. Its source is the npm package of that name, in which its licence lies, too; with
``pip install fonttools brotli``:

    npm pack @fontsource/stix-two-math@5.3.0 && tar xzf fontsource-stix-two-math-5.3.0.tgz
    python docs/math_font.py package/files/stix-two-math-latin-400-normal.woff2
    cp package/LICENSE docs/pages/assets/stix-two-math-licence.txt
"""

from __future__ import annotations

import sys
from pathlib import Path

from fontTools import subset

_FONT = Path(__file__).parent / "pages" / "assets" / "stix-two-math.woff2"
_CHARACTERS = (
    "20-7E,A0-FF,370-3FF"  # Latin and Greek
    ",2C6-2DD,300-338,2010-2057"  # accents, primes
    ",2100-214F,2190-21FF,2200-22FF,27C2,27F5-27FC"  # letters like R and l, arrows, operators
    ",2308-230B,23DC-23E1,27E6-27EF"  # brackets
    ",1D400-1D503,1D538-1D56B,1D6A4-1D71B"  # bold, italic, script and double-struck letters, as MathML asks for them
)

if __name__ == "__main__":
    # without hinting, which screens of today do not need; the table MATH, which places scripts and accents, is kept
    options = [f"--unicodes={_CHARACTERS}", "--layout-features=*", "--no-hinting", "--flavor=woff2"]
    subset.main([sys.argv[1], *options, f"--output-file={_FONT}"])

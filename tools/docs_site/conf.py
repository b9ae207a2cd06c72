"""Sphinx's settings. No time stamps, no network: the same sources give the same site."""

project = "loopbook"
author = "the loopbook developers"
project_copyright = "text, figures and exercise sheets CC BY 4.0, code MIT"
extensions = ["myst_parser", "sphinx_copybutton", "docs_site.mathml"]
myst_enable_extensions = ["dollarmath", "colon_fence", "attrs_inline"]
myst_heading_anchors = 3
html_math_renderer = "mathml"
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_title = "loopbook"
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"light_css_variables": {"color-brand-primary": "#1f5f8b", "color-brand-content": "#1f5f8b"}}
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
default_role = "literal"
add_module_names = False
python_display_short_literal_types = True
pygments_style = "friendly"
language = "en"

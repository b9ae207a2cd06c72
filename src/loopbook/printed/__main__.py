"""``python -m loopbook.printed``: derive every form anew and write ``forms.json``."""

from loopbook.printed.store import FILE, forms_text

if __name__ == "__main__":
    FILE.write_text(forms_text(), encoding="utf-8")
    print(FILE)

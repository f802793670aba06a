"""Markdown tables that are also aligned as plain text, and the numbers in them."""


def table(head, rows):
    """A table; the first column is aligned left, the others right."""
    widths = [max(len(row[column]) for row in [head, *rows]) for column in range(len(head))]

    def line(row):
        cells = [cell.rjust(width) if column else cell.ljust(width)
                 for column, (cell, width) in enumerate(zip(row, widths))]
        return "| " + " | ".join(cells) + " |\n"

    rule = "|" + "|".join("-" * (width + 1) + (":" if column else "-") for column, width in enumerate(widths)) + "|\n"
    return line(head) + rule + "".join(line(row) for row in rows)


def decimal(value, decimals):
    """A number with this many decimals; "-" for None."""
    return "-" if value is None else f"{value:.{decimals}f}"


def seconds(value):
    """Seconds with three significant digits, but at most four decimals; "-" for None."""
    if value is None:
        return "-"
    return decimal(value, 4 - sum(value >= limit for limit in (0.1, 1.0, 10.0)))


def mebibytes(size):
    """Bytes in MiB, rounded up."""
    return str(-(-size // 2**20))


def percent(share):
    return decimal(100 * share, 0) + " %"


def times(ratio):
    """A ratio such as "2.00 x"; "-" for None."""
    return "-" if ratio is None else decimal(ratio, 2 if ratio < 10 else 1) + " x"

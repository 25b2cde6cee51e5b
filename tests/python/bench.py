"""Prints how long a picture takes after a change of a setting: the medians of some runs, from the call to the array."""

import statistics
import time

import specula


def median_ms(work, runs):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append((time.perf_counter() - start) * 1e3)
    return statistics.median(times)


def main():
    start = time.perf_counter()
    with specula.Session("sphere-grid", size=(640, 360)) as s:
        s.render()
        print(f"start to the first picture   {(time.perf_counter() - start) * 1e3:8.0f} ms")
        values = iter(range(10_000))

        def change(path, scale):
            return lambda: s.set(path, (next(values) % 100 + 1) * scale)

        def both(path, scale, **options):
            set_it = change(path, scale)

            def work():
                set_it()
                s.render(**options)

            return work

        print("640x360, sphere-grid, studio          median")
        print(f"render, nothing changed      {median_ms(s.render, 20):8.1f} ms")
        print(f"render(raw=True)             {median_ms(lambda: s.render(raw=True), 20):8.1f} ms")
        print(f"set of the exposure          {median_ms(change('view.ev', 0.01), 20):8.1f} ms")
        print(f"exposure, then render        {median_ms(both('view.ev', 0.01), 20):8.1f} ms")
        s["material.enabled"] = True
        print(f"roughness, then render       {median_ms(both('material.roughness', 0.01), 20):8.1f} ms")
        print(f"roughness, then render raw   {median_ms(both('material.roughness', 0.01, raw=True), 20):8.1f} ms")
        print(f"roughness, then render(\"d\")  {median_ms(both('material.roughness', 0.01, mode='d'), 20):8.1f} ms")


main()

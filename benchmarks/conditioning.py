"""How long a covariance in single precision stays one, by form: prints the table of `plantc.examples.conditioning`."""

from plantc.examples.conditioning import main

if __name__ == "__main__":
    main()
